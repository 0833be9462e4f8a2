//! The e-puck's program for a STM32F407, the chip of ST's Discovery board: infrared on PA0 to PA7, wheels on PD12 and PD13, the
//! bridges' enable on PD14.
#![no_std]
#![no_main]
#![forbid(unsafe_code)]

use cortex_m as _;

use adapters::{Converter, Fault, Period};
use cortex_m_rt::entry;
use e_puck::{CURVE, EPuck};
use stm32f4xx_hal::adc::Adc;
use stm32f4xx_hal::adc::config::{AdcConfig, SampleTime};
use stm32f4xx_hal::gpio::{Analog, PA0, PA1, PA2, PA3, PA4, PA5, PA6, PA7};
use stm32f4xx_hal::pac::{ADC1, Peripherals};
use stm32f4xx_hal::prelude::*;
use stm32f4xx_hal::watchdog::IndependentWatchdog;

/// The control step of `e-puck.toml` and its tolerance [us].
const STEP: u32 = 100_000;
const LATE: u32 = 5_000;

/// The chip restarts after this time without a step [ms]. The bridges are off until then.
const WATCHDOG: u32 = 250;

/// Waits for the watchdog.
#[panic_handler]
fn panic(_: &core::panic::PanicInfo<'_>) -> ! {
    loop {}
}

/// The converter with a pin for each sensor, in the order of the exported table.
struct Infrared {
    adc: Adc<ADC1>,
    pins: (PA0<Analog>, PA1<Analog>, PA2<Analog>, PA3<Analog>, PA4<Analog>, PA5<Analog>, PA6<Analog>, PA7<Analog>),
}

impl Converter for Infrared {
    type Error = Fault;

    fn count(&mut self, sensor: usize) -> Result<u16, Fault> {
        const TIME: SampleTime = SampleTime::Cycles_144;
        let Self { adc, pins } = self;
        Ok(match sensor {
            0 => adc.convert(&pins.0, TIME),
            1 => adc.convert(&pins.1, TIME),
            2 => adc.convert(&pins.2, TIME),
            3 => adc.convert(&pins.3, TIME),
            4 => adc.convert(&pins.4, TIME),
            5 => adc.convert(&pins.5, TIME),
            6 => adc.convert(&pins.6, TIME),
            7 => adc.convert(&pins.7, TIME),
            _ => return Err(Fault::Read),
        })
    }
}

#[entry]
fn main() -> ! {
    // The first call returns the peripherals.
    let Some(board) = Peripherals::take() else { loop {} };
    let mut rcc = board.RCC.constrain();
    let (a, d) = (board.GPIOA.split(&mut rcc), board.GPIOD.split(&mut rcc));
    let pins = (
        a.pa0.into_analog(),
        a.pa1.into_analog(),
        a.pa2.into_analog(),
        a.pa3.into_analog(),
        a.pa4.into_analog(),
        a.pa5.into_analog(),
        a.pa6.into_analog(),
        a.pa7.into_analog(),
    );
    let infrared = Infrared { adc: Adc::new(board.ADC1, true, AdcConfig::default(), &mut rcc), pins };

    // Above the audible range. Half of a period is a wheel at rest.
    let (_, (left, right, ..)) = board.TIM4.pwm_hz(20.kHz(), &mut rcc);
    let mut wheels = [left.with(d.pd12).erase(), right.with(d.pd13).erase()];
    for wheel in &mut wheels {
        wheel.set_duty(wheel.get_max_duty() / 2);
        wheel.enable();
    }

    let mut clock = board.TIM2.counter_us(&mut rcc);
    let started = clock.start(u32::MAX.micros());
    // Damaged bytes: nothing moves.
    let (Ok(mut robot), Ok(())) = (EPuck::new(infrared, CURVE, wheels), started) else { loop {} };
    let mut watchdog = IndependentWatchdog::new(board.IWDG);
    watchdog.start(WATCHDOG.millis());
    let mut bridges = d.pd14.into_push_pull_output();
    bridges.set_high();

    let mut period = Period::new(STEP, LATE);
    let mut next = clock.now().ticks();
    loop {
        // A difference of more than half of the range of counts is in the past.
        while clock.now().ticks().wrapping_sub(next) > u32::MAX / 2 {}
        next = next.wrapping_add(STEP);
        // After a fault the wheels rest, and the loop continues.
        let _ = robot.tick(period.tick(clock.now().ticks()));
        watchdog.feed();
    }
}
