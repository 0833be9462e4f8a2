use farsa_body::*;
use farsa_experiments::reach_grasp_lift::{Config, Scene};
use farsa_physics::articulated::{Model, World};
use farsa_body::World as _;
#[test]
fn tmp() {
    let scene = Scene::new(Config { time_step: 0.001, substeps: 1, ..Config::default() }).unwrap();
    for body in [8u16, 9, 12, 6] { for depth in [0.0001f32, 0.0003, 0.001] {
        let mut world = World::new(Model::<f32>::new(&scene.robot, &scene.config.options()).unwrap());
        world.clear(); world.arranged();
        let collider = scene.robot.colliders.iter().find(|c| c.body == Some(BodyId(body))).unwrap();
        let at = world.pose(BodyId(body)).compose(&collider.placement.cast::<f32>()).position;
        let th = if body == 6 { 0.010 } else { [0.0065, 0.0060, 0.0055][(body as usize - 8) % 4] };
        world.place_body(Tabletop::SPHERE, Pose::at([at[0], at[1], at[2] - th - 0.025 + depth]), Twist::default());
        world.arranged();
        let pair = if body == 6 { scene.sphere_on_palm } else { scene.sphere_on_phalanges[(body as usize - 8) / 4 * 3 + (body as usize - 8) % 4] };
        print!("{body} {depth} name {:?} ", scene.robot.pairs[pair.index()].colliders.map(|c| scene.robot.colliders[c].name.clone()));
        for _ in 0..4 { world.step(); let c = world.pair_contact(pair); print!(" [{} {:.2} {:.5} v {:?}]", c.points, c.normal_force, c.depth, world.velocity(Tabletop::SPHERE).linear[2]); }
        println!();
    }}
}
