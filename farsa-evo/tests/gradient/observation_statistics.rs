//! Running statistics against sums over everything.

use crate::errors;
use farsa_evo::ObservationStatistics;
use farsa_evo::{EvoError, Snapshot};
use farsa_num::Stream;
use proptest::prelude::*;

fn rows(seed: u64, count: usize, channels: usize) -> Vec<Vec<f32>> {
    let mut stream = Stream::from_seed(seed);
    let mut row = || (0..channels).map(|channel| 100.0 * channel as f32 + 3.0 * stream.normal()).collect();
    (0..count).map(|_| row()).collect()
}

fn from_rows(rows: &[Vec<f32>], channels: usize) -> ObservationStatistics {
    let mut statistics = ObservationStatistics::new(channels).unwrap();
    assert!(rows.iter().all(|row| statistics.push(row)));
    statistics
}

fn close(got: &[f64], want: &[f64]) {
    let pairs = || got.iter().zip(want);
    assert!(pairs().all(|(got, want)| (got - want).abs() <= 1e-12 * (1.0 + want.abs())), "{got:?}\n{want:?}");
}

proptest! {
    #[test]
    fn parts_make_the_whole(seed: u64, count in 0..200usize, cut in 0..200usize, channels in 1..5usize) {
        let rows = rows(seed, count, channels);
        let (left, right) = rows.split_at(cut.min(count));
        let whole = from_rows(&rows, channels);
        let mut merged = from_rows(left, channels);
        merged.merge(&from_rows(right, channels)).unwrap();
        prop_assert_eq!(merged.count(), count as u64);
        close(merged.mean(), whole.mean());
        close(merged.squares(), whole.squares());

        // Two passes over everything.
        for channel in 0..if count == 0 { 0 } else { channels } {
            let values = || rows.iter().map(|row| f64::from(row[channel]));
            let mean = values().sum::<f64>() / count as f64;
            let squares = values().map(|x| (x - mean) * (x - mean)).sum::<f64>();
            close(&[whole.mean()[channel], whole.squares()[channel]], &[mean, squares]);
            close(&[whole.variance().nth(channel).unwrap()], &[squares / count as f64]);
        }

        let mut restored = ObservationStatistics::new(channels).unwrap();
        restored.restore(&merged.save()).unwrap();
        prop_assert_eq!(restored, merged);
    }
}

#[test]
fn rows_are_normalised() {
    let rows = rows(5, 1000, 3);
    let statistics = from_rows(&rows, 3);
    let mut normal = ObservationStatistics::new(3).unwrap();
    for mut row in rows {
        statistics.normalize(&mut row, 2.5);
        assert!(row.iter().all(|x| x.abs() <= 2.5));
        normal.push(&row);
    }
    assert!(normal.mean().iter().all(|mean| mean.abs() < 0.02), "{normal:?}");
    assert!(normal.variance().all(|variance| (variance - 1.0).abs() < 0.1), "{normal:?}");

    let mut row = [f32::INFINITY, f32::NEG_INFINITY, f32::NAN];
    statistics.normalize(&mut row, 10.0);
    assert_eq!(row[..2], [10.0, -10.0]);
    assert!(row[2].is_nan());
    let mut row = [f32::INFINITY, 7.0, -7.0];
    ObservationStatistics::new(3).unwrap().normalize(&mut row, 10.0);
    assert_eq!(row, [0.0; 3]);
    let mut row = [1e9, 0.0, 0.0];
    statistics.normalize(&mut row, f32::NAN);
    assert!(row[0] > 1e6);
}

#[test]
fn what_cannot_be_is_left_out() {
    let mut statistics = from_rows(&rows(1, 10, 2), 2);
    let before = statistics.clone();
    for wrong in [f32::NAN, f32::INFINITY] {
        assert!(!statistics.push(&[0.0, wrong]));
    }
    let refused = |result: Result<(), EvoError>| match result.unwrap_err() {
        EvoError::OutOfRange { field, value, .. } => (field, value),
        other => panic!("{other:?}"),
    };
    assert_eq!(refused(statistics.add(1, &[0.0; 3], &[0.0; 2])), ("channels", 3.0));
    assert_eq!(refused(statistics.add(1, &[0.0; 2], &[0.0; 1])), ("channels", 1.0));
    assert_eq!(refused(statistics.add(1, &[0.0, 1e101], &[0.0; 2])), ("mean", 1e101));
    assert_eq!(refused(statistics.add(1, &[0.0; 2], &[0.0, -1.0])), ("squares", -1.0));
    assert_eq!(refused(statistics.add(u64::MAX, &[0.0; 2], &[0.0; 2])).0, "count");
    assert_eq!(refused(statistics.merge(&ObservationStatistics::new(5).unwrap())), ("channels", 5.0));
    assert_eq!(statistics.add(0, &[3.0; 2], &[0.0; 2]), Ok(()));
    assert_eq!(refused(ObservationStatistics::new(0).map(|_| ())), ("channels", 0.0));
    let state = statistics.save();
    let expected = errors::state_length(40, 39);
    assert_eq!(statistics.restore(&state[1..]), Err(expected));
    for (place, wrong) in [(8, f64::NAN), (16, 1e300), (24, -1.0), (32, f64::INFINITY)] {
        let mut state = state.clone();
        state[place..place + 8].copy_from_slice(&wrong.to_le_bytes());
        assert!(matches!(statistics.restore(&state), Err(EvoError::State { .. })));
    }
    assert_eq!(statistics, before);
}

/// The largest that can be added stays finite.
#[test]
fn the_largest_batches_stay_finite() {
    let mut statistics = ObservationStatistics::new(1).unwrap();
    for sign in [1.0, -1.0, 1.0] {
        statistics.add(u64::MAX / 3, &[sign * 1e100], &[1e250]).unwrap();
        assert!(statistics.mean()[0].abs() <= 1e100 && statistics.squares()[0] <= 1e250);
    }
    let mut other = ObservationStatistics::new(1).unwrap();
    other.restore(&statistics.save()).unwrap();
    assert_eq!(other, statistics);
    assert_eq!(ObservationStatistics::from_saved(&statistics.save()), Ok(statistics.clone()));
    let state = statistics.save();
    for length in (0..24).chain([25, 39]) {
        let state: Vec<u8> = state.iter().copied().cycle().take(length).collect();
        assert!(matches!(ObservationStatistics::from_saved(&state), Err(EvoError::State { .. })), "{length}");
    }
}
