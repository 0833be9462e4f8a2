//! The conversion of a whole configuration.

use std::collections::BTreeSet;
use std::path::Path;

use farsa_lab::advanced::{ImportedFile, LeftOut};
use farsa_lab::{Error, Experiment as _, Settings};

use crate::channels::{Device, MAX_PARTS, Part};
use crate::evolution::Evolution;
use crate::experiment::Experiment;
use crate::ini::{Group, Ini};
use crate::motor::motor;
use crate::network::{MAX_NEURONS, Network};
use crate::remarks::Remarks;
use crate::robot::RobotKind;
use crate::sensor::sensor;
use crate::written::Written;
use farsa_compose::{ComposedExperiment, Limits};

/// Most remarks of each sort in the experiment file.
const MAX_REPEATED: usize = 200;

/// Converts a configuration of the 2013 program FARSA, versions 1 and 2, into an experiment file. The robots are
/// kinematic, on wheels.
///
/// `file` is the name of the configuration and `name` that of the experiment file. The new text begins with a remark
/// for each line that is lost. The function checks that the text is a valid experiment.
///
/// Source: the format and the defaults of \[FARSA2\]. Among its plugins it converts fitness, walls and starts of
/// `KheperaDiscriminationExperiment` only. All others are C++ code, and their experiments have a fitness of 0.
///
/// ```
/// use farsa_original::from_original;
///
/// let text = "[Component/GA]
/// nreproducing = 10
/// noffspring = 1
/// [Component/GA/Experiment]
/// type = LightExperiment
/// ntrials = 8
/// [Component/GA/Experiment/ROBOT]
/// type = Epuck
/// [Component/GA/Experiment/Sensor:0]
/// type = EpuckProximityIRSensor
/// [Component/GA/Experiment/Motor:0]
/// type = EpuckWheelVelocityMotor
/// ";
/// let imported = from_original("light.ini", "light.toml", text)?;
/// assert!(imported.text.contains("trials = 8"));
/// assert_eq!(imported.left[0].line, Some(5)); // the fitness of a plugin
/// # Ok::<(), farsa_lab::Error>(())
/// ```
///
/// # Errors
/// [`Error::Usage`] for a text that is not a configuration, and for one without a wheeled robot, sensor or motor that can be
/// converted. Texts of more than a megabyte or 5000 lines, and group names of more than 200 bytes, are errors, too.
/// [`Error::Setting`] for a robot without wheels. The errors of an experiment file for parts that do not fit together.
pub fn from_original(file: &str, name: &str, text: &str) -> Result<ImportedFile, Error> {
    from_original_within(Limits::default(), file, name, text)
}

/// Converts a configuration with other [`Limits`] of the experiment than the default ones.
///
/// # Errors
/// As [`from_original`].
pub fn from_original_within(limits: Limits, file: &str, name: &str, text: &str) -> Result<ImportedFile, Error> {
    let ini = Ini::from_text(file, text)?;
    let mut remarks = Remarks::default();
    let general = ini.group("TOTAL99");
    let main = general.and_then(|group| group.text("mainComponent", &mut remarks));
    let main = main.map_or("Component", |entry| &*entry.value);
    let summary = general.map_or_else(String::new, |group| read_general(group, &mut remarks));
    let agents = ini.numbered(&format!("{main}/GA/Experiment"), "AGENT");
    for group in ini.group(main).into_iter().chain(agents.first().copied()) {
        group.idle(&["type"], "is the part that holds the others", &mut remarks);
    }
    for test in ini.numbered(main, "TEST") {
        group_is_about(test, "`farsa test` tests a champion", &mut remarks);
    }
    let within = format!("{main}/GA/Experiment");
    let Some(group) = ini.group(&within) else {
        return Err(Error::Usage(format!("{file}: no group `[{within}]`: describes no evolution of robots")));
    };
    let [world, arena] = ["World", "Arena"].map(|name| ini.group(&format!("{within}/{name}")));
    let agent = agents.first().map_or(&*within, |group| &*group.path);
    let robot = ini.numbered(agent, "ROBOT").into_iter().next();
    let robot = robot.ok_or_else(|| Error::Usage(format!("{file}: no group `[{agent}/ROBOT]`: has no robot")))?;
    let robot = RobotKind::from_group(file, robot, &mut remarks)?;
    let parts = Parts::from_groups(file, &ini, agent, robot, &mut remarks)?;
    let none = Group { path: format!("{agent}/NET"), line: 0, entries: Vec::new() };
    let network = ["CONTROLLER", "NET"].iter().find_map(|name| ini.group(&format!("{agent}/{name}")));
    let network = Network::from_group(network.unwrap_or(&none), &mut remarks);
    let neurons = parts.channels() + network.hidden;
    if neurons > MAX_NEURONS {
        return Err(Error::Usage(format!(
            "{file}: a network of {neurons} neurons, where the original has {MAX_NEURONS}"
        )));
    }
    let none = Group { path: format!("{main}/GA"), line: 0, entries: Vec::new() };
    let search = ini.group(&format!("{main}/GA"));
    let search = Evolution::from_group(file, search.unwrap_or(&none), &mut remarks)?;
    // The last part, because all its other keys belong to the plugin.
    let experiment = Experiment::from_groups(group, world, arena, &mut remarks);
    remarks.finish(&ini);
    let Remarks { left, idle, more, .. } = remarks;

    let mut out = Written::default();
    let same_genes = robot == RobotKind::Khepera && network.same_genes && parts.same_channels;
    write_head(&mut out, [file, name], &search, same_genes, [(&left, more[0]), (&idle, more[1])]);
    out.word("summary", if summary.is_empty() { "a configuration of the original FARSA" } else { &summary });
    experiment.write_world(&mut out);
    robot.write(experiment.agents, &mut out);
    parts.write(&mut out);
    network.write(&mut out);
    experiment.write_task(&mut out);
    search.write(&mut out);
    let text = out.into_text();
    check(limits, name, &text)
        .map_err(|error| Error::Usage(format!("{file}: what comes out of it cannot be: {error}")))?;
    Ok(ImportedFile { text, left, idle, more_left: more[0], more_idle: more[1] })
}

/// Checks that a text is a valid experiment.
fn check(limits: Limits, name: &str, text: &str) -> Result<(), Error> {
    let made = ComposedExperiment::from_text_within(limits, name, text, farsa_lab::strategy::strategies())?;
    made.prepare("", &Settings::new(made.settings(""))?).map(drop)
}

/// Parts whose channels have the order of the 2013 program.
const SAME: [&str; 5] = ["infrared", "light", "ground-color", "wheel-speed", "wheels"];

/// The sensors and motors of a robot.
struct Parts {
    sensors: Vec<Part>,
    motors: Vec<Part>,
    /// True if inputs and outputs have the order of the 2013 program.
    same_channels: bool,
}

impl Parts {
    fn from_groups(file: &str, ini: &Ini, agent: &str, robot: RobotKind, remarks: &mut Remarks) -> Result<Self, Error> {
        let mut parts = Self { sensors: Vec::new(), motors: Vec::new(), same_channels: false };
        let [sensors, motors] = ["SENSOR", "MOTOR"].map(|name| ini.numbered(agent, name));
        let wanted = [sensors.len(), motors.len()];
        for (count, what) in wanted.into_iter().zip(["sensors", "motors"]) {
            if count > MAX_PARTS {
                return Err(Error::Usage(format!("{file}: {count} {what}, where {MAX_PARTS} are the most")));
            }
        }
        for group in sensors {
            let device = Device::from_group(file, ini, group, "Input", remarks)?;
            parts.sensors.extend(device.and_then(|device| sensor(&device, robot, remarks)));
        }
        for group in motors {
            let device = Device::from_group(file, ini, group, "Output", remarks)?;
            parts.motors.extend(device.and_then(|device| motor(&device, remarks)));
        }
        let lesioned = |part: &Part| part.wrappers.iter().any(|wrapper| wrapper.contains("lesion"));
        let mut all = parts.sensors.iter().chain(&parts.motors);
        let same = all.all(|part| SAME.contains(&part.kind) && !lesioned(part));
        parts.same_channels = same && wanted == [parts.sensors.len(), parts.motors.len()];
        for (list, what) in [(&mut parts.sensors, "sensor"), (&mut parts.motors, "motor")] {
            let mut names = BTreeSet::new();
            for part in list.iter_mut() {
                part.name_once(&mut names);
            }
            if list.is_empty() {
                let why = format!("{file}: no {what} of it can be carried over");
                let lost: Vec<String> = remarks.left.iter().take(5).map(ToString::to_string).collect();
                return Err(Error::Usage([vec![why], lost].concat().join("; ")));
            }
        }
        Ok(parts)
    }

    fn channels(&self) -> u64 {
        self.sensors.iter().chain(&self.motors).map(|part| part.channels).sum()
    }

    fn write(&self, out: &mut Written) {
        for (list, table) in [(&self.sensors, "[[sensors]]"), (&self.motors, "[[motors]]")] {
            for part in list {
                part.write(table, out);
            }
        }
    }
}

/// Returns the name. Author, plugin and other keys become remarks.
fn read_general(group: &Group, remarks: &mut Remarks) -> String {
    let summary = group.text("name", remarks).map(|entry| entry.value.clone()).unwrap_or_default();
    let keys = ["author", "date", "version", "description", "pluginFile", "pluginPath", "logLevel", "batchFile"];
    group.idle(&keys, "is about the original's program and its people", remarks);
    summary
}

/// Marks all lines of a group as without effect.
fn group_is_about(group: &Group, why: &str, remarks: &mut Remarks) {
    remarks.ask(group, "type");
    for entry in &group.entries {
        remarks.idle(group, entry, why);
    }
}

/// Writes origin, command line and lost lines.
fn write_head(
    out: &mut Written,
    [file, name]: [&str; 2],
    search: &Evolution,
    same_genes: bool,
    [left, idle]: [(&[LeftOut], usize); 2],
) {
    // Only the names, because paths belong to the machine of the import.
    let [file, name] =
        [file, name].map(|path| Path::new(path).file_name().and_then(|name| name.to_str()).unwrap_or(path));
    out.comment(&format!("Made of {file}, a configuration of the original FARSA. Lengths are metres."));
    let seed = if search.seed == 0 { String::new() } else { format!(" --seed {}", search.seed) };
    let replications = search.replications;
    out.comment(&format!("Its runs: farsa run {name}{seed} --replications {replications}"));
    out.comment(if same_genes {
        "Genotypes of the original (.gen) have the same genes in the same order."
    } else {
        "Genotypes of the original (.gen) have other genes, or in another order: they mean other networks here."
    });
    for ((list, more), what) in [(left, "Not carried over as it is:"), (idle, "Without effect here:")] {
        if list.is_empty() {
            continue;
        }
        out.comment("");
        out.comment(what);
        for remark in list.iter().take(MAX_REPEATED) {
            out.comment(&format!("- {remark}"));
        }
        let repeated = list.len().min(MAX_REPEATED);
        if list.len() + more > repeated {
            out.comment(&format!("- and {} more", list.len() + more - repeated));
        }
    }
    out.space();
}
