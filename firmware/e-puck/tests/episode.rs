//! The expected results of boards for the recorded episode.

use firmware_e_puck::{CHANGE, CURVE, SENSORS, STEPS, WHEELS, champion, reading, run_episode};

#[test]
fn the_episode_has_its_hash() {
    let mut ticks = 0;
    let (hash, safe) = run_episode(|tick| {
        tick();
        ticks += 1;
    })
    .expect("a robot");
    assert!(safe && ticks == STEPS, "{ticks} of {STEPS} ticks, safe: {safe}");
    let golden = include_str!("../../golden.txt").lines().find_map(|line| line.strip_prefix("episode "));
    assert_eq!(format!("{hash:016x}"), golden.expect("the line"));
}

/// The layer in double precision, written out. It checks that `run_episode` follows the exported table of channels.
#[test]
fn the_robot_does_what_the_network_says() {
    use adapters::Converter;
    use embedded_hal::pwm::{ErrorType, SetDutyCycle};
    use firmware_e_puck::EPuck;

    struct Counts<'a>(&'a std::cell::Cell<[u16; SENSORS]>);
    impl Converter for Counts<'_> {
        type Error = ();
        fn count(&mut self, sensor: usize) -> Result<u16, ()> {
            Ok(self.0.get()[sensor])
        }
    }
    struct Pin<'a>(&'a std::cell::Cell<u16>);
    impl ErrorType for Pin<'_> {
        type Error = std::convert::Infallible;
    }
    impl SetDutyCycle for Pin<'_> {
        fn max_duty_cycle(&self) -> u16 {
            1000
        }
        fn set_duty_cycle(&mut self, duty: u16) -> Result<(), Self::Error> {
            self.0.set(duty);
            Ok(())
        }
    }

    let counts = std::cell::Cell::new([0; SENSORS]);
    let duties = [std::cell::Cell::new(0), std::cell::Cell::new(0)];
    let mut robot = EPuck::new(Counts(&counts), CURVE, [Pin(&duties[0]), Pin(&duties[1])]).expect("a robot");
    let parameters = champion().expect("the champion");
    let mut last = [0.5; WHEELS];
    let mut sensed = 0;
    for step in 0..STEPS {
        counts.set(std::array::from_fn(|sensor| reading(step, sensor).expect("a reading")));
        robot.tick(Ok(())).expect("no fault");
        for wheel in 0..WHEELS {
            let mut sum = f64::from(parameters[SENSORS * WHEELS + wheel]);
            for (sensor, count) in counts.get().into_iter().enumerate() {
                sum += f64::from(parameters[sensor * WHEELS + wheel]) * f64::from(count) / 4095.0;
            }
            let asked = 1.0 / (1.0 + (-sum).exp());
            assert!((f64::from(robot.asked()[wheel]) - asked).abs() < 1e-6, "step {step}, wheel {wheel}");
            let change = f64::from(CHANGE);
            let driven = asked.clamp(last[wheel] - change, last[wheel] + change);
            assert!((f64::from(robot.driven()[wheel]) - driven).abs() < 1e-6, "step {step}, wheel {wheel}");
            assert!((f64::from(duties[wheel].get()) - 1000.0 * driven).abs() <= 0.51, "step {step}, wheel {wheel}");
            last[wheel] = f64::from(robot.driven()[wheel]);
        }
        sensed += usize::from(counts.get().iter().any(|count| *count > 0));
    }
    // The episode has a visible object, and an end.
    assert!(2 * sensed > STEPS, "{sensed} of {STEPS} steps");
    assert_eq!([reading(STEPS, 0), reading(0, SENSORS), reading(usize::MAX, 0)], [None; 3]);
}
