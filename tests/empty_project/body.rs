use farsa_body::kinematics::KinematicTree;
use farsa_body::robots::ArmAndHand;

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let arm = KinematicTree::new(&ArmAndHand::default().robot()?)?;
    let torques = arm.gravity_torques(&arm.poses(&arm.zero()), [0.0, 0.0, -9.81]);
    Ok(println!("{:.3} N m hold the shoulder", torques[1]))
}
