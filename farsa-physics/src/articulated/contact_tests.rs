//! Contact points of every pair of shapes against brute force, and what must hold for all of them.
#![allow(clippy::unwrap_used)]

extern crate std;

use alloc::vec::Vec;

use farsa_body::Pose;
use farsa_body::ports::BodyId;
use farsa_body::robot::{Collider, Joint, MassProperties, Robot, Segment, Shape, Surface};
use proptest::prelude::*;

use super::{find, halves_of_boxes, place_colliders};
use crate::articulated::boxes::{BOX_POINTS, find_boxes};
use crate::articulated::collision::{PlacedShape, Point};
use crate::articulated::{Model, Options, Scratch};

type V = [f64; 3];

fn dot(a: V, b: V) -> f64 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}
fn norm(a: V) -> f64 {
    dot(a, a).sqrt()
}
fn add(a: V, b: V, k: f64) -> V {
    [a[0] + k * b[0], a[1] + k * b[1], a[2] + k * b[2]]
}
fn sub(a: V, b: V) -> V {
    add(a, b, -1.0)
}

/// The points that the world looks at, of two shapes on two free bodies.
fn points_in<R: farsa_num::Real>(a: (Shape, Pose<f64>), b: (Shape, Pose<f64>)) -> Vec<Point<R>> {
    let mut robot = Robot::new("two");
    for (name, (shape, place)) in [("a", a), ("b", b)] {
        // Half of the pose in the body, half in the collider.
        let inner = Pose { position: [0.01, -0.02, 0.03], rotation: [0.5, -0.5, 0.5, 0.5] };
        let back = Pose { position: [0.0; 3], rotation: [-0.5, 0.5, -0.5, 0.5] };
        let mut body = place.compose(&back.compose(&Pose::at([-0.01, 0.02, -0.03])));
        let n = body.rotation.iter().map(|x| x * x).sum::<f64>().sqrt();
        body.rotation = body.rotation.map(|x| x / n);
        let id = robot.add_segment(Segment::new(name, None, Joint::floating(body), MassProperties::sphere(1.0, 0.1)));
        robot.add_collider(Collider::new(name, Some(id), shape, inner));
    }
    assert_eq!(robot.segments.len(), BodyId(2).index());
    robot.add_pair([0, 1], Surface { friction: 1.0, rolling_friction: 0.0, stiffness: 1e5, damping: 100.0 });
    let model = Model::<R>::new(&robot, &Options::default()).unwrap();
    let mut scratch = Scratch::new((), &model);
    scratch.forward_kinematics((), &model, &model.initial);
    let mut placed = [PlacedShape::new(()), PlacedShape::new(())];
    place_colliders((), &model, scratch.links(), &mut placed);
    let pair = &model.pairs[0];
    let sign = R::from_f64(if pair.flipped { -1.0 } else { 1.0 });
    let mut manifold = [Point::new(()); BOX_POINTS];
    let found: Vec<Point<R>> = match halves_of_boxes(&model, pair) {
        Some(halves) => {
            find_boxes((), pair.colliders.map(|c| &placed[c]), halves, &mut manifold);
            manifold.to_vec()
        }
        None => (0..pair.points).map(|i| find((), &model, pair, &placed, i)).collect(),
    };
    found.into_iter().map(|p| Point { normal: p.normal.map(|x| x * sign), ..p }).collect()
}

fn points(a: (Shape, Pose<f64>), b: (Shape, Pose<f64>)) -> Vec<Point<f64>> {
    points_in(a, b)
}

fn valid(points: &[Point<f64>]) -> impl Iterator<Item = &Point<f64>> {
    points.iter().filter(|p| p.valid)
}

fn gap(points: &[Point<f64>]) -> f64 {
    valid(points).map(|p| p.gap).fold(f64::INFINITY, f64::min)
}

/// Signed distance of a point to the surface of a shape.
fn distance(shape: Shape, place: &Pose<f64>, p: V) -> f64 {
    let p = place.transform_back(p);
    match shape {
        Shape::Sphere { radius } => norm(p) - radius,
        Shape::Capsule { radius, half_length } => {
            norm(sub(p, [0.0, 0.0, p[2].clamp(-half_length, half_length)])) - radius
        }
        Shape::Box { half } => {
            let q = [0, 1, 2].map(|k: usize| p[k].abs() - half[k]);
            norm(q.map(|x| x.max(0.0))) + q[0].max(q[1]).max(q[2]).min(0.0)
        }
        Shape::Cylinder { radius, half_length } => {
            let q = [norm([p[0], p[1], 0.0]) - radius, p[2].abs() - half_length];
            norm([q[0].max(0.0), q[1].max(0.0), 0.0]) + q[0].max(q[1]).min(0.0)
        }
        Shape::Plane => p[2],
    }
}

/// The smallest value of a convex function on [-h, h].
fn least(h: f64, f: &mut dyn FnMut(f64) -> f64) -> f64 {
    let (mut a, mut b) = (-h, h);
    for _ in 0..100 {
        let (x, y) = ((2.0 * a + b) / 3.0, (a + 2.0 * b) / 3.0);
        if f(x) < f(y) { b = y } else { a = x }
    }
    f(f64::midpoint(a, b))
}

fn along(place: &Pose<f64>, t: f64) -> V {
    place.transform([0.0, 0.0, t])
}

fn corners(half: V, place: &Pose<f64>) -> Vec<V> {
    (0..8)
        .map(|i| place.transform([0, 1, 2].map(|k: usize| if i >> k & 1 == 0 { -half[k] } else { half[k] })))
        .collect()
}

fn edges(half: V, place: &Pose<f64>) -> Vec<(V, V)> {
    let c = corners(half, place);
    (0..8)
        .flat_map(|i| [1, 2, 4].into_iter().filter(move |b| i & b == 0).map(move |b| (i, i | b)))
        .map(|(i, j)| (c[i], c[j]))
        .collect()
}

/// Distance of two segments.
fn between(a: (V, V), b: (V, V)) -> f64 {
    let at = |s: (V, V), t: f64| add(s.0, sub(s.1, s.0), f64::midpoint(t, 1.0));
    let point_to = |p: V| {
        let d = sub(b.1, b.0);
        let t = (dot(sub(p, b.0), d) / dot(d, d)).clamp(0.0, 1.0);
        norm(sub(p, add(b.0, d, t)))
    };
    least(1.0, &mut |t| point_to(at(a, t)))
}

/// The largest separation of two boxes along the fifteen axes of [Ericson2005] section 4.4.1, negative where they
/// overlap.
fn separation(ha: V, pa: &Pose<f64>, hb: V, pb: &Pose<f64>) -> f64 {
    let axes = |p: &Pose<f64>| [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]].map(|e| p.rotate(e));
    let (a, b) = (axes(pa), axes(pb));
    let cross = |u: V, v: V| [u[1] * v[2] - u[2] * v[1], u[2] * v[0] - u[0] * v[2], u[0] * v[1] - u[1] * v[0]];
    let crosses = a.iter().flat_map(|u| b.iter().map(move |v| cross(*u, *v))).filter(|c| norm(*c) > 1e-6);
    let d = sub(pa.position, pb.position);
    let along = |n: V| {
        let reach = |axes: [V; 3], h: V| (0..3).map(|k| h[k] * dot(axes[k], n).abs()).sum::<f64>();
        (dot(d, n).abs() - reach(a, ha) - reach(b, hb)) / norm(n)
    };
    a.into_iter().chain(b).chain(crosses).map(along).fold(f64::NEG_INFINITY, f64::max)
}

/// The smallest signed gap of two shapes by brute force. For boxes that overlap it is the least overlap along an axis.
fn brute((sa, pa): (Shape, Pose<f64>), (sb, pb): (Shape, Pose<f64>)) -> f64 {
    match (sa, sb) {
        (Shape::Sphere { radius }, _) => distance(sb, &pb, pa.position) - radius,
        (Shape::Capsule { radius, half_length }, _) => {
            least(half_length, &mut |t| distance(sb, &pb, along(&pa, t))) - radius
        }
        (Shape::Box { half }, Shape::Plane) => {
            corners(half, &pa).into_iter().map(|c| distance(sb, &pb, c)).fold(f64::INFINITY, f64::min)
        }
        (Shape::Cylinder { radius, half_length }, Shape::Plane) => {
            // Both rims, point by point. The lowest one is searched between its neighbors.
            let height = |end: f64, angle: f64| {
                let (sine, cosine) = farsa_num::sin_cos(angle);
                distance(sb, &pb, pa.transform([radius * cosine, radius * sine, end * half_length]))
            };
            let step = core::f64::consts::TAU / 64.0;
            let mut lowest = f64::INFINITY;
            for end in [-1.0, 1.0] {
                for k in 0..64 {
                    let middle = f64::from(k) * step;
                    lowest = lowest.min(least(step, &mut |t| height(end, middle + t)));
                }
            }
            lowest
        }
        (Shape::Box { half: ha }, Shape::Box { half: hb }) => {
            let overlap = separation(ha, &pa, hb, &pb);
            if overlap <= 0.0 {
                return overlap;
            }
            let mut d = f64::INFINITY;
            for c in corners(ha, &pa) {
                d = d.min(distance(sb, &pb, c));
            }
            for c in corners(hb, &pb) {
                d = d.min(distance(sa, &pa, c));
            }
            for a in edges(ha, &pa) {
                for b in edges(hb, &pb) {
                    d = d.min(between(a, b));
                }
            }
            d
        }
        _ => brute((sb, pb), (sa, pa)),
    }
}

fn pose(reach: f64) -> impl Strategy<Value = Pose<f64>> {
    let turn = prop::array::uniform4(-1.0..1.0)
        .prop_filter("a direction", |q: &[f64; 4]| q.iter().map(|x| x * x).sum::<f64>() > 0.01);
    (prop::array::uniform3(-reach..reach), turn).prop_map(|(position, q)| {
        let n = q.iter().map(|x| x * x).sum::<f64>().sqrt();
        Pose { position, rotation: q.map(|x| x / n) }
    })
}

fn ball() -> impl Strategy<Value = Shape> {
    (0.005..0.05).prop_map(|radius| Shape::Sphere { radius })
}
fn capsule() -> impl Strategy<Value = Shape> {
    (0.005..0.03, 0.005..0.08).prop_map(|(radius, half_length)| Shape::Capsule { radius, half_length })
}
fn block() -> impl Strategy<Value = Shape> {
    prop::array::uniform3(0.01..0.1).prop_map(|half| Shape::Box { half })
}
fn cylinder() -> impl Strategy<Value = Shape> {
    (0.005..0.08, 0.005..0.08).prop_map(|(radius, half_length)| Shape::Cylinder { radius, half_length })
}
fn any_pair() -> impl Strategy<Value = [Shape; 2]> {
    let round = || prop_oneof![ball(), capsule()];
    let shapes = || prop_oneof![ball(), capsule(), block()];
    prop_oneof![
        8 => (round(), shapes()).prop_map(|(a, b)| [a, b]),
        4 => (shapes(), Just(Shape::Plane)).prop_map(|(a, b)| [a, b]),
        2 => (block(), block()).prop_map(|(a, b)| [a, b]),
        2 => (shapes(), round()).prop_map(|(a, b)| [a, b]),
        4 => (round(), cylinder()).prop_map(|(a, b)| [a, b]),
        2 => (cylinder(), Just(Shape::Plane)).prop_map(|(a, b)| [a, b]),
        1 => (cylinder(), round()).prop_map(|(a, b)| [a, b]),
    ]
}

/// The tolerance of the search along an axis for the deepest place, and of boxes for preferring one axis to another.
fn slack(shapes: [Shape; 2]) -> f64 {
    match shapes {
        [Shape::Capsule { half_length, .. }, Shape::Box { .. } | Shape::Cylinder { .. }]
        | [Shape::Box { .. } | Shape::Cylinder { .. }, Shape::Capsule { half_length, .. }] => {
            1.5e-3 * half_length + 1e-9
        }
        [Shape::Box { .. }, Shape::Box { .. }] => 3e-5,
        _ => 1e-9,
    }
}

fn boxes(shapes: [Shape; 2]) -> bool {
    shapes.iter().all(|s| matches!(s, Shape::Box { .. }))
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 1000, failure_persistence: None, ..ProptestConfig::default() })]

    #[test]
    fn the_smallest_gap_is_that_of_brute_force(shapes in any_pair(), pa in pose(0.1), pb in pose(0.1)) {
        let contact = points((shapes[0], pa), (shapes[1], pb));
        let (g, truth) = (gap(&contact), brute((shapes[0], pa), (shapes[1], pb)));
        prop_assert!((g - truth).abs() <= slack(shapes), "{g} instead of {truth}");
    }

    #[test]
    fn points_lie_midway_between_the_surfaces(shapes in any_pair(), pa in pose(0.1), pb in pose(0.1)) {
        for p in valid(&points((shapes[0], pa), (shapes[1], pb))) {
            prop_assert!((norm(p.normal) - 1.0).abs() < 1e-12);
            let (on_a, on_b) = (add(p.position, p.normal, p.gap / 2.0), add(p.position, p.normal, -p.gap / 2.0));
            let (da, db) = (distance(shapes[0], &pa, on_a), distance(shapes[1], &pb, on_b));
            if boxes(shapes) {
                prop_assert!(da.abs().max(db.abs()) <= slack(shapes), "{da} {db}");
            } else {
                // On a capsule that is deep in a box, or flat on it, an end's ball may be within the capsule.
                let round_first = matches!(shapes[0], Shape::Sphere { .. } | Shape::Capsule { .. });
                let (round, other) = if round_first { (da, db) } else { (db, da) };
                prop_assert!(round <= 1e-9 && other.abs() <= 1e-9, "{da} {db}");
            }
        }
    }

    #[test]
    fn moving_both_moves_the_points(shapes in any_pair(), pa in pose(0.1), pb in pose(0.1), by in pose(1.0)) {
        let here = points((shapes[0], pa), (shapes[1], pb));
        let there = points((shapes[0], by.compose(&pa)), (shapes[1], by.compose(&pb)));
        // Where two answers are equally good, rounding decides: the smallest gap is the same whatever the answer.
        if gap(&here).is_finite() || gap(&there).is_finite() {
            prop_assert!((gap(&here) - gap(&there)).abs() <= 1e-9 + slack(shapes));
        }
        for (p, q) in here.iter().zip(&there) {
            if p.valid && q.valid && norm(sub(q.normal, by.rotate(p.normal))) < 1e-3 {
                prop_assert!(norm(sub(q.position, by.transform(p.position))) < 1e-6);
                prop_assert!((p.gap - q.gap).abs() < 1e-9);
            }
        }
    }

    #[test]
    fn exchanging_the_two_reverses_the_normal(shapes in any_pair(), pa in pose(0.1), pb in pose(0.1)) {
        let (ab, ba) = (points((shapes[0], pa), (shapes[1], pb)), points((shapes[1], pb), (shapes[0], pa)));
        if boxes(shapes) {
            // A face of the first of two boxes is preferred, so the points may be others.
            prop_assert!((gap(&ab) - gap(&ba)).abs() <= slack(shapes));
            return Ok(());
        }
        prop_assert_eq!(ab.len(), ba.len());
        for (p, q) in ab.iter().zip(&ba) {
            prop_assert!((p.gap - q.gap).abs() < 1e-12 && p.valid == q.valid);
            if norm(add(p.normal, q.normal, 1.0)) > 1e-9 {
                // Capsules that cross may be pushed apart either way.
                let round = |s: &Shape| matches!(s, Shape::Capsule { .. } | Shape::Sphere { .. });
                prop_assert!(shapes.iter().all(round));
            }
        }
    }

    #[test]
    fn a_gap_changes_no_faster_than_the_shapes_move(
        shapes in any_pair(), pa in pose(0.1), pb in pose(0.1), by in prop::array::uniform3(-0.02..0.02),
    ) {
        let moved = Pose { position: add(pa.position, by, 1.0), ..pa };
        let (before, after) = (points((shapes[0], pa), (shapes[1], pb)), points((shapes[0], moved), (shapes[1], pb)));
        prop_assert!((gap(&before) - gap(&after)).abs() <= norm(by) + slack(shapes));
        // And along the normal as fast as that, while the shapes are apart.
        let Some(p) = valid(&before).min_by(|a, b| a.gap.total_cmp(&b.gap)) else { return Ok(()) };
        if p.gap > 1e-3 {
            let away = Pose { position: add(pa.position, p.normal, 1e-4), ..pa };
            let g = gap(&points((shapes[0], away), (shapes[1], pb)));
            prop_assert!((g - p.gap - 1e-4).abs() < 2e-6 + slack(shapes), "{} {g}", p.gap);
        }
    }

    #[test]
    fn single_precision_agrees(shapes in any_pair(), pa in pose(0.1), pb in pose(0.1)) {
        let wide = points((shapes[0], pa), (shapes[1], pb));
        let narrow = points_in::<f32>((shapes[0], pa), (shapes[1], pb));
        let least = narrow.iter().filter(|p| p.valid).map(|p| f64::from(p.gap)).fold(f64::INFINITY, f64::min);
        if least.is_finite() && gap(&wide).is_finite() {
            prop_assert!((least - gap(&wide)).abs() <= 1e-6 + slack(shapes));
        }
    }
}

/// A box of half edges from 5 to 90 mm, or of 50 mm, turned at random or by a multiple of an eighth of a turn about an
/// axis.
fn random_block(s: &mut farsa_num::Stream, reach: f64) -> (V, Pose<f64>) {
    let special = s.below(3) == 0;
    let half = if special { [0.05; 3] } else { core::array::from_fn(|_| s.range_f64(0.005, 0.09)) };
    let position = core::array::from_fn(|_| s.range_f64(-reach, reach));
    let mut rotation: [f64; 4] = core::array::from_fn(|_| s.range_f64(-1.0, 1.0));
    if special {
        let (sine, cosine) = farsa_num::sin_cos(f64::from(s.below(8)) * core::f64::consts::FRAC_PI_8);
        rotation = [0.0, 0.0, 0.0, cosine];
        rotation[s.below(3) as usize] = sine;
    }
    let n = rotation.iter().map(|x| x * x).sum::<f64>().sqrt();
    (half, Pose { position, rotation: rotation.map(|x| x / n) })
}

/// Boxes apart, touching, deep in each other and at the same place.
#[test]
fn the_gap_of_random_boxes_is_that_of_separating_axes() {
    use farsa_num::{Domain, Stream};
    let mut s = Stream::new(1, Domain::Start, 0, 0, 0);
    let mut counts = [0; 2];
    for round in 0..8_000 {
        let reach = [0.0, 0.03, 0.08, 0.12][round % 4];
        let ((ha, pa), (hb, pb)) = (random_block(&mut s, reach), random_block(&mut s, reach));
        let (a, b) = ((Shape::Box { half: ha }, pa), (Shape::Box { half: hb }, pb));
        let truth = brute(a, b);
        let (wide, narrow) = (gap(&points(a, b)), points_in::<f32>(a, b));
        let single = narrow.iter().filter(|p| p.valid).map(|p| p.gap).fold(f32::INFINITY, f32::min);
        for (name, found) in [("f64", wide), ("f32", f64::from(single))] {
            assert!((found - truth).abs() < 5e-5, "{name}: {found} instead of {truth}: {a:?} {b:?}");
        }
        counts[usize::from(truth > 0.0)] += 1;
    }
    assert!(counts.iter().all(|n| *n > 1500), "overlapping and apart: {counts:?}");
}

#[test]
fn a_capsule_across_an_edge_touches_with_its_middle() {
    // A box with its top at z = 0. The capsule lies across its edge at x = 0.1, tilted, both ends clear.
    let table = (Shape::Box { half: [0.1, 0.1, 0.1] }, Pose::at([0.0, 0.0, -0.1]));
    for degrees in [30.0_f64, 45.0, 60.0] {
        let (s, c) = farsa_num::sin_cos(degrees.to_radians());
        for gap_wanted in [0.002, -0.001] {
            // Out of the edge between the two faces' normals. The axis falls across it.
            let n = [s, 0.0, c];
            let direction = [c, 0.0, -s];
            let radius = 0.006;
            let middle = add([0.1, 0.0, 0.0], n, radius + gap_wanted);
            // A frame whose z axis is that direction.
            let angle = farsa_num::atan2(direction[0], direction[2]);
            let (s, c) = farsa_num::sin_cos(angle / 2.0);
            let capsule = (
                Shape::Capsule { radius, half_length: 0.03 },
                Pose { position: add(middle, direction, 0.004), rotation: [0.0, s, 0.0, c] },
            );
            let contact = points(capsule, table);
            assert!(contact[2].valid, "{degrees} deg");
            assert!((contact[2].gap - gap_wanted).abs() < 3e-5, "{} for {gap_wanted}", contact[2].gap);
            assert!(contact[0].gap > 0.005 && contact[1].gap > 0.005);
            if gap_wanted > 0.0 {
                assert!(norm(sub(contact[2].normal, n)) < 0.01, "{:?} for {n:?}", contact[2].normal);
            }
        }
    }
    // Lying flat on the top, it touches with its ends and the middle does not count.
    let flat = Pose { position: [0.0, 0.0, 0.005], rotation: [0.0, 0.5_f64.sqrt(), 0.0, 0.5_f64.sqrt()] };
    let contact = points((Shape::Capsule { radius: 0.006, half_length: 0.03 }, flat), table);
    assert!(contact[0].valid && contact[1].valid && !contact[2].valid);
    assert!(contact[..2].iter().all(|p| (p.gap + 0.001).abs() < 1e-12 && norm(sub(p.normal, [0.0, 0.0, 1.0])) < 1e-12));
}

#[test]
fn shapes_with_one_centre_are_pushed_apart() {
    let at = Pose::at([0.1, 0.2, 0.3]);
    for (a, b) in [
        (Shape::Sphere { radius: 0.02 }, Shape::Sphere { radius: 0.03 }),
        (Shape::Sphere { radius: 0.02 }, Shape::Capsule { radius: 0.01, half_length: 0.05 }),
        (Shape::Capsule { radius: 0.02, half_length: 0.03 }, Shape::Capsule { radius: 0.01, half_length: 0.05 }),
        (Shape::Sphere { radius: 0.02 }, Shape::Box { half: [0.03, 0.05, 0.04] }),
        (Shape::Box { half: [0.05; 3] }, Shape::Box { half: [0.05; 3] }),
    ] {
        let contact = points((a, at), (b, at));
        assert!(valid(&contact).count() > 0);
        for p in valid(&contact) {
            assert!((norm(p.normal) - 1.0).abs() < 1e-12 && p.gap < 0.0 && p.gap.is_finite());
        }
    }
}
