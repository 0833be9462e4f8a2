use farsa_num::{Domain, Stream, logistic};

fn main() {
    let mut noise = Stream::new(42, Domain::Sensor, 0, 0, 0);
    let readings = [0.2_f32, 0.5, 0.8].map(|x| logistic(4.0 * x - 2.0 + 0.1 * noise.normal()));
    println!("{readings:.3?}");
}
