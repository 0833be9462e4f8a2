use farsa_models::{Imported, ReadOptions, urdf};

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let text = r#"<mujoco><worldbody><body name="arm">
        <joint name="hinge" axis="0 1 0" range="-90 90"/><geom size="0.1"/></body></worldbody></mujoco>"#;
    let arm = Imported::from_text(text, &ReadOptions::default())?.robot;
    println!("{} joint, {} lines of URDF", arm.joints().count(), urdf::write(&arm)?.lines().count());
    Ok(())
}
