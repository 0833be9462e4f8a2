//! Which of the three models reads a robot's infrared sensors, as settings.

use std::path::PathBuf;
use std::sync::Arc;

use farsa_body::ports::{BodyId, Channels, Handles, Kinematics, Planar, Rays, Sensor};
use farsa_body::robots::MobileRobot;
use farsa_body::sensors::Beam;
use farsa_body::sensors::infrared::{
    InfraredDrawing, InfraredFormula, InfraredRays, InfraredTable, InfraredTables, SampledInfrared,
};
use farsa_body::{ChannelError, Pose, Recorder};
use farsa_lab::{Error, Setting, Settings, read_text_file};

const MODEL: &str = "robot.infrared";
const TABLES: &str = "robot.infrared_tables";
const AUTO: &str = "auto";
const ANALYTIC: &str = "analytic";
const RAYS: &str = "rays";
const SAMPLED: &str = "sampled";

/// The measured tables in a directory; for round bodies with the radius at which they were measured \[m\].
const WALLS: &str = "wall.sam";
const BODIES: [(&str, f32); 2] = [("small.sam", 0.0125), ("round.sam", 0.027)];

/// The most bytes that are read of a table.
const MOST_BYTES: u64 = 256_000_000;

/// A model of infrared sensors.
#[derive(Clone, Debug, PartialEq, Default)]
pub enum InfraredModel {
    /// By a formula, [`InfraredFormula`].
    #[default]
    Analytic,
    /// By rays, [`InfraredRays`].
    Rays,
    /// By measured tables, [`SampledInfrared`].
    Sampled(Arc<InfraredTables>),
}

impl InfraredModel {
    /// The two settings that choose the model.
    pub fn settings() -> Vec<Setting> {
        vec![
            Setting::word(MODEL, AUTO, &[AUTO, ANALYTIC, RAYS, SAMPLED]).doc(
                "Model of the infrared sensors: a formula, rays, or measured tables as the source's; auto takes tables where \
                 they are named, else the formula, which needs no files.",
            ),
            Setting::text(TABLES, "").doc("Directory of wall.sam, small.sam and round.sam for the model `sampled`."),
        ]
    }

    /// The setting that chooses between the models that need no tables, this one by default: for robots that have not
    /// been measured.
    pub fn without_tables(&self) -> Setting {
        let name = if *self == Self::Rays { RAYS } else { ANALYTIC };
        Setting::word(MODEL, name, &[RAYS, ANALYTIC]).doc(
            "Model of the infrared sensors: rays, as far as this robot's sensors see, or the formula, whose distances are a \
             Khepera's.",
        )
    }

    /// The files that the model reads under these settings.
    ///
    /// # Errors
    /// [`Error::Setting`] if measured tables are wanted and no directory is named.
    pub fn files(settings: &Settings) -> Result<Vec<PathBuf>, Error> {
        if !settings.table().iter().any(|setting| setting.key() == TABLES) {
            return Ok(Vec::new());
        }
        let directory = settings.text(TABLES)?;
        match (settings.word(MODEL)?, directory.is_empty()) {
            (SAMPLED, true) => {
                let why = format!("names no directory of tables, which `{MODEL} = \"{SAMPLED}\"` needs");
                return Err(Error::setting(TABLES, why));
            }
            (SAMPLED | AUTO, false) => {}
            _ => return Ok(Vec::new()),
        }
        Ok(core::iter::once(WALLS)
            .chain(BODIES.map(|(name, _)| name))
            .map(|name| PathBuf::from(directory).join(name))
            .collect())
    }

    /// The model of these settings, with its tables.
    ///
    /// # Errors
    /// Those of [`files`](Self::files), [`Error::Io`] and [`Error::Damaged`] for a file that cannot be read, and what is wrong in a table.
    pub fn read(settings: &Settings) -> Result<Self, Error> {
        let paths = Self::files(settings)?;
        if paths.is_empty() {
            return Ok(if settings.word(MODEL)? == RAYS { Self::Rays } else { Self::Analytic });
        }
        let mut tables = Vec::new();
        for path in paths {
            let text = read_text_file(&path, MOST_BYTES)?;
            let table = InfraredTable::parse(&text);
            tables.push(table.map_err(|error| Error::setting(TABLES, format!("{}: {error}", path.display())))?);
        }
        let walls = tables.remove(0);
        let bodies = BODIES.iter().map(|(_, radius)| *radius).zip(tables).collect();
        let tables = InfraredTables::new(walls, bodies).map_err(|error| Error::setting(TABLES, error))?;
        Ok(Self::Sampled(Arc::new(tables)))
    }

    /// The word for it.
    pub fn name(&self) -> &'static str {
        match self {
            Self::Analytic => ANALYTIC,
            Self::Rays => RAYS,
            Self::Sampled(_) => SAMPLED,
        }
    }
}

/// The first infrared sensors of a robot, read by one of the models; one channel each in \[0, 1\].
#[derive(Clone, Debug)]
pub struct Infrared {
    ring: Ring,
    rays: InfraredDrawing,
}

#[derive(Clone, Debug)]
enum Ring {
    Analytic(InfraredFormula<Vec<[f32; 2]>>),
    Rays(InfraredRays<Vec<Beam>>),
    Sampled(SampledInfrared<Arc<InfraredTables>>),
}

impl Infrared {
    /// The first `sensors` of a robot whose body this is.
    ///
    /// # Errors
    /// [`ChannelError`] if the robot or the tables have fewer sensors, or no sensor can be built from their numbers.
    pub fn for_robot(
        robot: &MobileRobot,
        body: BodyId,
        sensors: usize,
        model: &InfraredModel,
    ) -> Result<Self, ChannelError> {
        let channels = robot.infrared.angles.len();
        if sensors > channels {
            return Err(ChannelError::Selection { start: 0, end: sensors, channels });
        }
        let mut part = robot.clone();
        part.infrared.angles.truncate(sensors);
        let ring = match model {
            InfraredModel::Analytic => Ring::Analytic(InfraredFormula::for_robot(&part, body)?),
            InfraredModel::Rays => Ring::Rays(InfraredRays::for_robot(&part, body)?),
            InfraredModel::Sampled(tables) => {
                let all = SampledInfrared::new(body, robot.radius as f32, Arc::clone(tables))?;
                Ring::Sampled(all.first(sensors)?)
            }
        };
        Ok(Self { ring, rays: InfraredDrawing::for_robot(&part, sensors) })
    }

    /// Records a ray for each sensor: it ends where an object would be that gives the same reading.
    ///
    /// `x` \[sensors\] is what was read when the robot was at `pose`.
    pub fn record(&self, pose: Pose, x: &[f32], recorder: &mut dyn Recorder) {
        self.rays.record(pose, x, false, recorder);
    }
}

impl Channels for Infrared {
    fn channels(&self) -> usize {
        self.rays.count()
    }
}

impl<W> Sensor<W> for Infrared
where
    W: Planar + Rays + Kinematics + Handles<Body = BodyId> + ?Sized,
{
    #[inline]
    fn read(&mut self, world: &W, out: &mut [f32]) {
        match &mut self.ring {
            Ring::Analytic(ring) => ring.read(world, out),
            Ring::Rays(ring) => ring.read(world, out),
            Ring::Sampled(ring) => ring.read(world, out),
        }
    }
}
