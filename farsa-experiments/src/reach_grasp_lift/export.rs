//! Export of the controller and the initial states of `reach-grasp-lift` for other programs.

use farsa_body::ports::{ActuatorId, BodyId, JointId, PairId};
use farsa_body::robot::Pair;
use farsa_body::robots::{ArmAndHand, Finger, Tabletop};
use farsa_lab::EpisodeId;
use farsa_lab::exports::{
    ActuatorExport, ControllerExport, JudgeExport, MotorDrive, MotorExport, NetworkExport, PointExport, SensorExport,
    SensorReading, ServoExport, StartExport, SurfaceExport,
};

use crate::reach_grasp_lift::config::{Labels, OUTPUTS, PLAIN_SENSORS};
use crate::reach_grasp_lift::phase::Phase;
use crate::reach_grasp_lift::scene::{Scene, TARGET_SCALE};

impl Scene {
    /// A network with the channels of this scene, named as they are there.
    pub(crate) fn controller(
        &self,
        network: NetworkExport,
        sensors: Vec<String>,
        outputs: Vec<String>,
    ) -> ControllerExport {
        let actuators = self.robot.actuators.iter().map(|actuator| ActuatorExport {
            name: actuator.name.clone(),
            joint: self.joint_name(actuator.joint),
            law: actuator.law,
        });
        let sensors = sensors.into_iter().zip(self.readings());
        let motors = outputs.into_iter().zip(self.drives());
        ControllerExport {
            network,
            sensors: sensors.map(|(name, reads)| SensorExport { name, reads }).collect(),
            motors: motors.map(|(name, drives)| MotorExport { name, drives }).collect(),
            actuators: actuators.collect(),
            surfaces: self.surfaces(),
            judge: Some(self.judge_by_name()),
            time_step: self.config.time_step,
            steps: self.config.steps,
        }
    }

    /// [`Scene::start`] by name, as a world takes it.
    pub(crate) fn start_by_name(&self, id: EpisodeId) -> StartExport {
        let (joints, [x, y]) = self.start(id);
        let joints = ArmAndHand::joints().into_iter().zip(joints);
        let at = [x, y, self.config.sphere_radius].map(|x| x as f32);
        StartExport {
            joints: joints.map(|(joint, q)| (self.joint_name(joint), q as f32)).collect(),
            bodies: vec![(self.body_name(Tabletop::SPHERE), at)],
        }
    }

    /// The quantity that every sensor channel reads, in the order of [`Scene::senses`].
    fn readings(&self) -> Vec<SensorReading> {
        let config = &self.config;
        let joints = self.sensed_joints().into_iter();
        let joints =
            joints.map(|(joint, [from, to])| SensorReading::JointPosition { joint: self.joint_name(joint), from, to });
        let saturation = config.touch_saturation as f32;
        let patches = self.patches().into_iter();
        let patches = patches.map(|pairs| SensorReading::Touch { pairs: self.pair_names(&pairs), saturation });
        let way = (0..3).map(|component| SensorReading::Way {
            target: self.point(Tabletop::SPHERE, [0.0; 3]),
            from: self.palm(),
            axes: config.target_axes,
            component,
            scale: TARGET_SCALE,
        });
        let amplitude = config.label_amplitude as f32;
        let labels = Phase::ALL.into_iter().filter_map(|phase| match config.labels {
            Labels::Given => Some(SensorReading::Label { phase: phase.name(), amplitude }),
            Labels::None => None,
            Labels::Own => Some(SensorReading::PreviousOutput { channel: OUTPUTS + phase.index(), scale: amplitude }),
        });
        joints.chain(patches).chain(way).chain(labels).collect()
    }

    /// The quantity that every output drives, in the order of [`Scene::output_names`].
    fn drives(&self) -> Vec<MotorDrive> {
        let muscles = (0..7).flat_map(|i| [0, 1].map(|muscle| (ActuatorId(i), muscle)));
        let muscles = muscles.map(|(pair, muscle)| MotorDrive::Muscle { actuator: self.actuator_name(pair), muscle });
        let groups = self.arm.servo_groups().into_iter().map(|group| {
            let servos = group.into_iter();
            let servos = servos.map(|s| ServoExport { actuator: self.actuator_name(s.servo), from: s.from, to: s.to });
            MotorDrive::Servos { servos: servos.collect() }
        });
        let labels = (0..self.config.labels.outputs()).map(|n| MotorDrive::NextInput { channel: PLAIN_SENSORS + n });
        muscles.chain(groups).chain(labels).collect()
    }

    fn surfaces(&self) -> Vec<SurfaceExport> {
        let surface = |number: usize, pair: &Pair| SurfaceExport {
            pair: self.pair_name(PairId(number as u16)),
            stiffness: pair.surface.stiffness,
            damping: pair.surface.damping,
        };
        self.robot.pairs.iter().enumerate().map(|(number, pair)| surface(number, pair)).collect()
    }

    fn judge_by_name(&self) -> JudgeExport {
        let tips = Finger::ALL.map(|finger| self.arm.fingertip(finger));
        JudgeExport {
            phases: Phase::ALL.map(Phase::name).to_vec(),
            target: self.body_name(Tabletop::SPHERE),
            palm: self.palm(),
            fingertips: tips.into_iter().map(|(body, at)| self.point(body, at)).collect(),
            on_fingers: self.pair_names(&self.sphere_on_phalanges),
            on_table: self.pair_name(self.sphere_on_table),
            success_height: self.config.judgement.success_height / 100.0,
            success_steps: self.config.steps_per_second(),
        }
    }

    fn palm(&self) -> PointExport {
        self.point(ArmAndHand::PALM, self.arm.palm_centre)
    }

    fn point(&self, body: BodyId, at: [f64; 3]) -> PointExport {
        PointExport { body: self.body_name(body), at }
    }

    fn body_name(&self, body: BodyId) -> String {
        self.robot.segments[body.index()].name.clone()
    }

    fn joint_name(&self, joint: JointId) -> String {
        self.robot.segments[joint.index()].joint.name.clone()
    }

    fn actuator_name(&self, actuator: ActuatorId) -> String {
        self.robot.actuators[actuator.index()].name.clone()
    }

    fn pair_name(&self, pair: PairId) -> [String; 2] {
        self.robot.pairs[pair.index()].colliders.map(|collider| self.robot.colliders[collider].name.clone())
    }

    fn pair_names(&self, pairs: &[PairId]) -> Vec<[String; 2]> {
        pairs.iter().map(|pair| self.pair_name(*pair)).collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use farsa_body::actuators::Law;
    use farsa_body::ports::{Channels, Contacts, Joints, Kinematics, Motor, Sensor, World as _};
    use farsa_body::sensors::Axes;
    use farsa_nn::{Controller, Leak, LeakyNetwork};
    use farsa_num::{Domain, Stream};
    use farsa_physics::articulated::{Model, World};

    use crate::reach_grasp_lift::config::Config;

    fn described(scene: &Scene, parameters: &[f32]) -> ControllerExport {
        let layout = scene.config.layout();
        let network = NetworkExport::leaky(&layout, Leak::Filter, parameters);
        scene.controller(network, scene.senses().unwrap().names(), scene.output_names(&scene.motors().unwrap()))
    }

    fn at(scene: &Scene, world: &World<f32>, point: &PointExport) -> [f64; 3] {
        world.pose(scene.robot.body(&point.body).unwrap()).cast::<f64>().transform(point.at)
    }

    /// The reading of a channel by its description alone.
    fn reading(scene: &Scene, world: &World<f32>, phase: Phase, reads: &SensorReading) -> f64 {
        match reads {
            SensorReading::JointPosition { joint, from, to } => {
                let q = world.position(scene.robot.joint(joint).unwrap());
                f64::from((q - from) / (to - from))
            }
            SensorReading::Touch { pairs, saturation } => {
                let touches = |pair: &&[String; 2]| world.touches(scene.robot.pair(&pair[0], &pair[1]).unwrap());
                (pairs.iter().filter(touches).count() as f64 / f64::from(*saturation)).min(1.0)
            }
            SensorReading::Way { target, from, axes, component, scale } => {
                let (to, own) = (at(scene, world, target), at(scene, world, from));
                let way = [0, 1, 2].map(|k| to[k] - own[k]);
                let body = world.pose(scene.robot.body(&from.body).unwrap()).cast::<f64>();
                let way = if *axes == Axes::Body { body.rotate_back(way) } else { way };
                way[*component] * f64::from(*scale)
            }
            SensorReading::Label { phase: named, amplitude } => {
                if phase.name() == *named {
                    f64::from(*amplitude)
                } else {
                    0.0
                }
            }
            other => panic!("{other:?} is none of this scene's"),
        }
    }

    /// The commands of all actuators for outputs, by the description alone.
    fn commands(scene: &Scene, motors: &[MotorExport], y: &[f32]) -> Vec<[f32; 2]> {
        let mut commands = vec![[0.0; 2]; scene.robot.actuators.len()];
        for (motor, y) in motors.iter().zip(y) {
            match &motor.drives {
                MotorDrive::Muscle { actuator, muscle } => {
                    commands[scene.robot.actuator(actuator).unwrap().index()][*muscle] = *y;
                }
                MotorDrive::Servos { servos } => {
                    for s in servos {
                        commands[scene.robot.actuator(&s.actuator).unwrap().index()][0] = s.from + (s.to - s.from) * y;
                    }
                }
                other => panic!("{other:?} is none of this scene's"),
            }
        }
        commands
    }

    /// Stores the commands.
    struct Commanded(Vec<[f32; 2]>);

    impl farsa_body::ports::Handles for Commanded {
        type Body = BodyId;
        type Joint = JointId;
        type Actuator = ActuatorId;
    }

    impl farsa_body::ports::Actuated for Commanded {
        fn command(&mut self, actuator: ActuatorId, value: [f32; 2]) {
            self.0[actuator.index()] = value;
        }
    }

    #[test]
    fn the_description_alone_senses_and_drives_as_the_scene_does() {
        for config in [Config::default(), Config { target_axes: Axes::World, ..Config::for_condition(Labels::None) }] {
            let scene = Scene::new(config).unwrap();
            let exported = described(&scene, &vec![0.0; scene.config.layout().parameter_count()]);
            let (mut senses, mut motors) = (scene.senses().unwrap(), scene.motors().unwrap());
            assert_eq!((exported.sensors.len(), exported.motors.len()), (senses.channels(), OUTPUTS));
            let mut world = World::new(Model::<f32>::new(&scene.robot, &scene.config.options()).unwrap());
            let mut stream = Stream::new(5, Domain::Motor, 0, 0, 0);
            let (mut x, mut touched) = (vec![0.0; exported.sensors.len()], 0);
            for step in 0..600 {
                if step % 150 == 0 {
                    scene.arrange(&mut world, EpisodeId { seed: 3, trial: step / 150, ..EpisodeId::default() });
                    let start = scene.start_by_name(EpisodeId { seed: 3, trial: step / 150, ..EpisodeId::default() });
                    for (joint, q) in &start.joints {
                        assert_eq!(world.position(scene.robot.joint(joint).unwrap()), *q);
                    }
                    let [(sphere, place)] = start.bodies.as_slice() else { panic!("{start:?}") };
                    assert_eq!(world.pose(scene.robot.body(sphere).unwrap()).position, *place);
                }
                let phase = Phase::ALL[step as usize / 50 % 3];
                senses.set_label(phase);
                senses.read(&world, &mut x);
                for (sensor, x) in exported.sensors.iter().zip(&x) {
                    let read = reading(&scene, &world, phase, &sensor.reads);
                    // Single precision, in centimeters. The sphere may fall far.
                    assert!(
                        (read - f64::from(*x)).abs() < 1e-6 * (10.0 + read.abs()),
                        "step {step}: {} {x} {read}",
                        sensor.name
                    );
                    touched += u32::from(matches!(sensor.reads, SensorReading::Touch { .. }) && *x > 0.0);
                }
                if step % 20 == 0 {
                    let y: [f32; OUTPUTS] = core::array::from_fn(|_| stream.uniform());
                    let mut commanded = Commanded(vec![[0.0; 2]; scene.robot.actuators.len()]);
                    motors.drive(&y, &mut commanded);
                    assert_eq!(commanded.0, commands(&scene, &exported.motors, &y));
                    motors.drive(&y, &mut world);
                }
                world.step();
            }
            assert!(touched > 20, "only {touched} touches were compared");
        }
    }

    #[test]
    fn own_labels_are_described_as_outputs_of_the_previous_step() {
        for label_amplitude in [1.0, 50.0] {
            let scene = Scene::new(Config { label_amplitude, ..Config::for_condition(Labels::Own) }).unwrap();
            let exported = described(&scene, &vec![0.0; scene.config.layout().parameter_count()]);
            assert_eq!([exported.sensors.len(), exported.motors.len()], exported.network.shape());
            for n in 0..3 {
                let (sensor, motor) = (&exported.sensors[26 + n], &exported.motors[23 + n]);
                let names = [format!("label {}", n + 1), format!("next label {}", n + 1)];
                assert_eq!([&sensor.name, &motor.name], [&names[0], &names[1]]);
                let scale = label_amplitude as f32;
                assert_eq!(sensor.reads, SensorReading::PreviousOutput { channel: 23 + n, scale });
                assert_eq!(motor.drives, MotorDrive::NextInput { channel: 26 + n });
            }
        }
    }

    #[test]
    fn the_described_network_computes_the_same() {
        let scene = Scene::new(Config::default()).unwrap();
        let layout = scene.config.layout();
        let mut stream = Stream::new(7, Domain::Motor, 0, 0, 0);
        let parameters: Vec<f32> = layout
            .kinds()
            .map(|kind| if kind == farsa_nn::LeakyParameter::Leak { stream.uniform() } else { stream.range(-6.0, 6.0) })
            .collect();
        let NetworkExport::Leaky { layout: told, parameters: exported, .. } = described(&scene, &parameters).network
        else {
            panic!("another network")
        };
        let told_parts = told.split(&exported);
        let state = vec![0.0; layout.state_len()];
        let mut network = LeakyNetwork::new(layout, Leak::Filter, parameters, state).unwrap();
        let sigma = |x: f64| 1.0 / (1.0 + farsa_num::exp(-f64::from(told.slope()) * x));
        let weight = |weights: &[f32], i: usize| f64::from(weights[i]);
        let (mut hidden, mut y) = (vec![0.0; told.hidden()], vec![0.0; told.outputs()]);
        for _ in 0..50 {
            let x: Vec<f32> = (0..told.sensors()).map(|_| stream.range(-2.0, 2.0)).collect();
            network.step(&x, &mut y);
            let next = |i: usize| {
                let mut net = f64::from(told_parts.biases[i]);
                net += (0..told.sensors())
                    .map(|j| f64::from(x[j]) * weight(told_parts.sensor_weights, j * told.hidden() + i))
                    .sum::<f64>();
                net += (0..told.hidden())
                    .map(|k| hidden[k] * weight(told_parts.recurrent_weights, k * told.hidden() + i))
                    .sum::<f64>();
                let leak = f64::from(told_parts.leaks[i]);
                leak * sigma(net) + (1.0 - leak) * hidden[i]
            };
            hidden = (0..told.hidden()).map(next).collect();
            for (i, y) in y.iter().enumerate() {
                let net: f64 = (0..told.hidden())
                    .map(|j| hidden[j] * weight(told_parts.output_weights, j * told.outputs() + i))
                    .sum();
                assert!((sigma(net) - f64::from(*y)).abs() < 1e-5, "output {i}");
            }
        }
    }

    #[test]
    fn actuators_have_names_and_laws() {
        let scene = Scene::new(Config::default()).unwrap();
        let exported = described(&scene, &vec![0.0; scene.config.layout().parameter_count()]);
        assert_eq!(exported.actuators.len(), 27);
        assert!(exported.actuators.iter().enumerate().all(|(i, a)| a.joint == format!("J{}", i + 1)));
        assert!(
            matches!(exported.actuators[6].law, Law::MusclePair(_))
                && matches!(exported.actuators[7].law, Law::Servo(_))
        );
        let judge = exported.judge.unwrap();
        assert_eq!((judge.on_fingers.len(), judge.fingertips.len(), judge.success_steps), (15, 5, 100));
        assert!(judge.on_table.contains(&"table".into()) && judge.target == "sphere");
    }
}
