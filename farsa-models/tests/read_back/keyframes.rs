//! States of an MJCF from which a simulation can start.

use farsa_body::Pose;
use farsa_body::ports::BodyId;
use farsa_models::mjcf::{self, Keyframe, MjcfOptions};

use crate::{message, read};

/// A body on a rail with a `ref`, with a hinge, next to a free body.
fn model(keys: &str) -> String {
    format!(
        "<mujoco><worldbody><body name='sled' pos='0 0 1'><joint name='rail' type='slide' axis='1 0 0' ref='0.25'/>\
         <geom type='sphere' size='0.1'/><body name='arm' pos='0.2 0 0'><joint name='hinge' axis='0 1 0' ref='30'/>\
         <geom type='sphere' size='0.1'/></body></body><body name='ball' pos='0 1 2'><freejoint/>\
         <geom type='sphere' size='0.1'/></body></worldbody><keyframe>{keys}</keyframe></mujoco>"
    )
}

/// A `qpos` is in radians also in a file in degrees, and its quaternion begins with w.
#[test]
fn keyframes_follow_the_configuration_of_the_file() {
    let keys = "<key name='far' qpos='0.5 -1.5 3 4 5 0 0 0 -2'/><key time='2'/>";
    let imported = read(&model(keys)).unwrap();
    let of_file = Keyframe {
        name: String::new(),
        joints: vec![0.25, 30.0_f64.to_radians()],
        bodies: vec![(BodyId(2), Pose::at([0.0, 1.0, 2.0]))],
    };
    let at = Pose { position: [3.0, 4.0, 5.0], rotation: [0.0, 0.0, -1.0, 0.0] };
    let far = Keyframe { name: "far".into(), joints: vec![0.5, -1.5], bodies: vec![(BodyId(2), at)] };
    assert_eq!(imported.keyframes, [of_file.clone(), far.clone(), Keyframe { name: "key1".into(), ..of_file.clone() }]);
    assert!(imported.warnings.iter().any(|warning| warning.what == "key `time`"), "{:?}", imported.warnings);
    // Writing and reading keeps them.
    let options = MjcfOptions { keyframes: vec![far.clone()], ..MjcfOptions::default() };
    let written = mjcf::write(&imported.robot, &options).unwrap();
    assert_eq!(read(&written).unwrap().keyframes[1], far);
    let urdf = "<robot name='r'><link name='a'><inertial><mass value='1'/><inertia ixx='1' iyy='1' izz='1' ixy='0' ixz='0' \
                iyz='0'/></inertial></link></robot>";
    let [only] = &read(urdf).unwrap().keyframes[..] else { panic!("one state of a URDF") };
    assert_eq!(*only, Keyframe { name: String::new(), joints: Vec::new(), bodies: Vec::new() });
}

#[test]
fn wrong_keyframes_are_refused_with_their_line() {
    for (key, why) in [
        ("<key qpos='0.5 -1.5'/>", "key: qpos is \"0.5 -1.5\""),
        ("<key qpos='0.5 -1.5 3 4 5 0 0 0 0'/>", "but must have quaternions that are not 0"),
        ("<key qpos='inf -1.5 3 4 5 1 0 0 0'/>", "but must be finite"),
        ("<key place='1'/>", "unknown attribute of key `place`"),
    ] {
        let error = message(&model(key));
        assert!(error.contains(why), "{error}");
    }
}
