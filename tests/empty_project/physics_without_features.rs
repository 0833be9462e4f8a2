use farsa_physics::articulated::Spatial;

fn main() {
    let turning = Spatial { angular: [0.0, 0.0, 2.0], linear: [0.0; 3] };
    let force = Spatial::force_at([0.3, 0.0, 0.0], [0.0, 5.0, 0.0]);
    println!("{:?} m/s, {:.3} W", turning.at([0.3, 0.0, 0.0]), turning.dot(force));
}
