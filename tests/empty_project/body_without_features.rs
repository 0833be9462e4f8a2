use farsa_body::actuators::MusclePair;

fn main() {
    let elbow = MusclePair::thesis(300.0, 0.02, [-1.0, 1.0]);
    let [agonist, antagonist] = [0.6, 0.2];
    println!("{:.3} N m", elbow.effort(0.1, 0.0, [agonist, antagonist]).torque);
}
