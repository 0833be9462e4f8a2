//! A controller of FARSA on a Cortex-M: read, step, drive.
#![no_std]
#![no_main]

use cortex_m_rt::entry;
use farsa_nn::bytes::{Aligned, BytesError, LeakyNetworkBytes};
use farsa_nn::{Controller, Leak, LeakyLayout, LeakyNetwork};

const LAYOUT: LeakyLayout = LeakyLayout::new({{sensors}}, {{hidden}}, {{motors}});

// `farsa export controller RUN --format bytes --out champion.farsa`. A file of another length does not compile.
static CHAMPION: Aligned<[u8; LeakyNetworkBytes::byte_count(LAYOUT)]> = Aligned(*include_bytes!("../champion.farsa"));

#[panic_handler]
fn panic(_: &core::panic::PanicInfo<'_>) -> ! {
    loop {}
}

fn champion() -> Result<LeakyNetwork<&'static [f32], [f32; LAYOUT.state_len()]>, BytesError> {
    let bytes = LeakyNetworkBytes::read(&CHAMPION.0)?;
    bytes.expect(LAYOUT, Leak::Filter)?;
    Ok(LeakyNetwork::new(LAYOUT, Leak::Filter, bytes.parameters()?, [0.0; LAYOUT.state_len()])?)
}

#[entry]
fn main() -> ! {
    // Damaged bytes: nothing moves.
    let Ok(mut network) = champion() else { loop {} };
    let (x, mut y) = ([0.0; {{sensors}}], [0.0; {{motors}}]);
    loop {
        // Wait for the next tick and read the sensors into x here,
        network.step(&x, &mut y);
        // and drive the motors with y.
    }
}
