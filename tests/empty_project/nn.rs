use farsa_nn::{Controller, Error, Leak, LeakyLayout, LeakyNetwork};

const LAYOUT: LeakyLayout = LeakyLayout::new(2, 3, 1);

fn main() -> Result<(), Error> {
    let mut network = LeakyNetwork::new(LAYOUT, Leak::Filter, [0.5; LAYOUT.parameter_count()], [0.0; LAYOUT.state_len()])?;
    let mut y = [0.0];
    network.step(&[0.3, 0.7], &mut y);
    Ok(println!("{y:.3?}"))
}
