//! Contacts of MJCF files in the articulated world, against MuJoCo's (`fixtures/contacts.py`).

use farsa_body::ports::{BodyId, World as _};
use farsa_models::mjcf::{self, MjcfOptions};
use farsa_physics::articulated::{Model, Options, World};

use crate::{fixture, read};

#[test]
fn contacts_stop_bodies_as_those_of_mujoco_do() {
    let cases: serde_json::Value = serde_json::from_str(&fixture("contacts.json")).unwrap();
    let cases = cases.as_array().unwrap();
    assert_eq!(cases.len(), 19);
    for (number, case) in cases.iter().enumerate() {
        let text = case["text"].as_str().unwrap();
        let imported = read(text).unwrap();
        let options = Options { substeps: 100, gravity: imported.gravity.unwrap(), ..Options::default() };
        // In the later cases bodies slide for half a meter, or a written robot has the friction of the file's impedance
        // ratio and slips by other amounts.
        let tolerances = if number < 11 { [3e-4; 2] } else { [5e-4, 1.5e-3] };
        let written = mjcf::write(&imported.robot, &MjcfOptions::default()).unwrap();
        for (robot, tolerance) in [&imported.robot, &read(&written).unwrap().robot].into_iter().zip(tolerances) {
            let mut world = World::new(Model::<f64>::new(robot, &options).unwrap());
            for (tick, place) in case["path"].as_array().unwrap().iter().enumerate() {
                world.step();
                let found = world.pose_of(BodyId(0)).position;
                for (k, x) in found.iter().enumerate() {
                    let wanted = place[k].as_f64().unwrap();
                    assert!((x - wanted).abs() < tolerance, "{text}\ntick {tick}: {found:?}, not {place}");
                }
            }
        }
    }
}

/// The powers that our contacts and stops have are read, others become 2 and are listed.
#[test]
fn other_powers_of_an_impedance_are_listed() {
    let listed = |contact: f64, limit: f64| {
        let text = format!(
            "<mujoco><worldbody><geom type='plane' size='1 1 1' solimp='0.9 0.95 0.001 0.5 {contact}'/>\
             <body pos='0 0 1'><joint axis='1 0 0' limited='true' range='-1 1' solimplimit='0.9 0.95 0.001 0.5 {limit}'/>\
             <geom size='0.1' solimp='0.9 0.95 0.001 0.5 {contact}'/></body></worldbody></mujoco>"
        );
        let found = read(&text).unwrap();
        let law = found.robot.pairs[0].soft.unwrap().impedance.unwrap();
        let notes = found.warnings.iter().filter(|note| note.why.contains("powers 1 and 2"));
        (notes.map(|note| note.what.clone()).collect::<Vec<_>>(), law.power)
    };
    assert_eq!(listed(2.0, 1.0), (vec![], 2));
    assert_eq!(listed(1.0, 3.0), (vec!["solimplimit".to_owned()], 1));
    assert_eq!(listed(4.0, 2.0), (vec!["solimp".to_owned()], 2));
}
