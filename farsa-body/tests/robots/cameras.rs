//! Readings of cameras and light sensors in the world of the plane.

use core::f32::consts::PI;

use crate::shared::{BLUE, GREEN, RED, bands, read};
use farsa_body::ports::{BodyId, Kinematics as _, Sight};
use farsa_body::robots::MobileRobot;
use farsa_body::sensors::{Beam, LightSensors, LinearCamera};
use farsa_body::testing::PlaneWorld;
use proptest::prelude::*;

#[test]
fn a_camera_tells_sides_and_colours_and_hides_what_is_behind() {
    let mut world = PlaneWorld::new();
    let parts = world.add_robot(&MobileRobot::khepera(), [0.0, 0.0], PI / 2.0);
    let mut camera = LinearCamera::for_view(parts.body, 2.0, 2, 100, bands(), 3.0).unwrap();
    // To the left of a robot that looks along y.
    let red = world.add_disc([-0.5, 1.0], 0.2, RED);
    let values = read(&mut camera, &world);
    let width = 2.0 * (0.2 / 1.25_f32.sqrt()).asin();
    assert!((values[0] - width).abs() < 0.011 && values[1..] == [0.0; 3], "{values:?}");
    // A blue disc before it in part. Then before all of it.
    let blue = world.add_disc([-0.35, 0.5], 0.05, BLUE);
    let part = read(&mut camera, &world);
    assert!(part[0] > 0.0 && part[0] < values[0] && part[1] > 0.0, "{part:?}");
    world.place(blue, [-0.1, 0.2], 0.0);
    let hidden = read(&mut camera, &world);
    assert!(hidden[0] == 0.0 && hidden[1] > 0.4 && hidden[2] == 0.0 && hidden[3] < 0.5, "{hidden:?}");
    // Other colors are seen as nothing, but they hide. Surfaces out of range are invisible, too.
    world.place(blue, [0.0, -1.0], 0.0);
    let green = world.add_disc([-0.25, 0.5], 0.15, GREEN);
    assert_eq!(read(&mut camera, &world), [0.0; 4]);
    world.place(green, [-1.9, 3.8], 0.0);
    assert_eq!(read(&mut camera, &world), values);
    world.place(red, [-1.9, 3.8], 0.0);
    assert_eq!(read(&mut camera, &world), [0.0; 4]);
}

/// Discs around a robot at the origin: bearing, distance of the center, radius as a share of it, color.
fn discs() -> impl Strategy<Value = Vec<(f32, f32, f32, usize)>> {
    prop::collection::vec((-PI..PI, 0.2_f32..2.0, 0.05_f32..0.6, 0_usize..3), 1..8)
}

fn world_of(discs: &[(f32, f32, f32, usize)], side: f32) -> PlaneWorld {
    let mut world = PlaneWorld::new();
    world.add_robot(&MobileRobot::khepera(), [0.0, 0.0], 0.0);
    for &(bearing, apart, share, color) in discs {
        let (s, c) = farsa_num::sin_cos(side * bearing);
        world.add_disc([apart * c, apart * s], apart * share, [RED, BLUE, GREEN][color]);
    }
    world
}

proptest! {
    /// Against discs as intervals of angles, sampled finely: the nearest of those that cover a direction is seen.
    #[test]
    fn a_camera_sees_what_fine_sampling_sees(discs in discs(), field in 0.5_f64..6.0, sectors in 1_usize..5) {
        const RAYS: usize = 200;
        const FINE: usize = 1000;
        // One cannot look out of what one is in.
        let mut camera = LinearCamera::for_view(BodyId(0), field, sectors, RAYS, bands(), 1.5).unwrap();
        let values = read(&mut camera, &world_of(&discs, 1.0));
        let part = field / sectors as f64;
        for sector in 0..sectors {
            let mut seen = [0.0_f64; 3];
            for fine in 0..FINE {
                let angle = 0.5 * field - part * (sector as f64 + (fine as f64 + 0.5) / FINE as f64);
                let mut nearest = (1.5, None);
                for &(bearing, apart, share, color) in &discs {
                    let off = (angle - f64::from(bearing)).rem_euclid(2.0 * std::f64::consts::PI);
                    let off = off.min(2.0 * std::f64::consts::PI - off);
                    let (apart, share) = (f64::from(apart), f64::from(share));
                    if off < share.asin() {
                        // The triangle of the two centers and the point that is seen, by the law of sines.
                        let at_point = std::f64::consts::PI - (farsa_num::sin_cos(off).0 / share).asin();
                        let at_centre = std::f64::consts::PI - at_point - off;
                        let distance = if off < 1e-9 { apart * (1.0 - share) } else {
                            apart * share * farsa_num::sin_cos(at_centre).0 / farsa_num::sin_cos(off).0 };
                        if distance < nearest.0 {
                            nearest = (distance, Some(color));
                        }
                    }
                }
                if let Some(color) = nearest.1 {
                    seen[color] += 1.0 / FINE as f64;
                }
            }
            for color in 0..2 {
                // Each edge of a disc, and each of its ends at the range, is a ray off at most.
                let (value, fine) = (f64::from(values[2 * sector + color]), seen[color]);
                let allowed = 4.0 * discs.len() as f64 / RAYS as f64;
                prop_assert!((value - fine).abs() <= allowed, "sector {sector}, colour {color}: {value} {fine}");
            }
            prop_assert!(values[2 * sector] + values[2 * sector + 1] <= 1.0 + 1e-6);
        }
    }

    /// Rays that cannot hit a color are left out. That must not change readings for few, many, near or surrounding
    /// discs, and for narrow or wide views.
    #[test]
    fn a_camera_reads_what_all_of_its_rays_see(
        discs in prop::collection::vec((-PI..PI, 0.01_f32..2.0, 0.05_f32..1.5, 0_usize..3), 0..24),
        aside in prop::array::uniform2(-0.3_f64..0.3),
        wall in prop::option::of(0_usize..3),
        field in prop::sample::select(vec![0.2, 0.9, 3.0, 6.0]),
    ) {
        const RAYS: usize = 30;
        let mut world = world_of(&discs, 1.0);
        if let Some(color) = wall {
            world.add_wall([[1.0, -1.0], [1.0, 2.0]], [RED, BLUE, GREEN][color]);
        }
        let beams: Vec<Beam> = (0..RAYS).map(|ray| Beam::in_view(aside, field, ray, RAYS)).collect();
        let mut camera = LinearCamera::new(BodyId(0), beams.clone(), 10, bands(), 1.5).unwrap();
        let values = read(&mut camera, &world);
        let mut from_pose = vec![f32::NAN; values.len()];
        camera.read_from(&world, &world.pose(BodyId(0)), &mut from_pose);
        prop_assert_eq!(&values, &from_pose);
        // The robot is at the origin and looks along x.
        let sights = beams.iter().map(|beam| world.cast_planar(beam.from, beam.direction, 1.5, Some(BodyId(0))));
        let seen: Vec<_> = sights.map(|sight| sight.map(|sight| sight.color)).collect();
        for (sector, colors) in seen.chunks(10).enumerate() {
            for (k, band) in bands().iter().enumerate() {
                let count = colors.iter().flatten().filter(|color| band.shows(**color)).count();
                prop_assert_eq!(values[2 * sector + k], count as f32 / 10.0, "sector {} colour {}", sector, k);
            }
        }
    }

    #[test]
    fn cameras_and_lamps_are_mirror_symmetric(discs in discs(), lamp in (-PI..PI, 0.2_f32..2.0)) {
        const SECTORS: usize = 5;
        const RAYS: usize = 40;
        let b = BodyId(0);
        let (mut left, mut right) = (world_of(&discs, 1.0), world_of(&discs, -1.0));
        for (world, side) in [(&mut left, 1.0), (&mut right, -1.0)] {
            let (s, c) = farsa_num::sin_cos(side * lamp.0);
            world.add_lamp([lamp.1 * c, lamp.1 * s], 0.01, 1.0);
        }
        let mut camera = LinearCamera::for_view(b, 5.0, SECTORS, RAYS, bands(), 1.5).unwrap();
        let (here, there) = (read(&mut camera, &left), read(&mut camera, &right));
        for sector in 0..SECTORS {
            for color in 0..2 {
                let (x, y) = (here[2 * sector + color], there[2 * (SECTORS - 1 - sector) + color]);
                // One ray that grazes an edge.
                prop_assert!((x - y).abs() < 1.5 / RAYS as f32, "{sector} {color}: {here:?} {there:?}");
            }
        }
        // The e-puck's: left and right in order, then the two behind.
        let mut light = LightSensors::for_robot(&MobileRobot::e_puck(), b, 0.5).unwrap();
        let (here, there) = (read(&mut light, &left), read(&mut light, &right));
        let mirrored = [5, 4, 3, 2, 1, 0, 7, 6].map(|i| there[i]);
        let gaps = here.iter().zip(mirrored).filter(|(x, y)| (*x - y).abs() > 1e-3).count();
        // The sight of a lamp that grazes a disc.
        prop_assert!(gaps <= 1, "{here:?} {mirrored:?}");
    }
}
