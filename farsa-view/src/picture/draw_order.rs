//! Order of shapes from back to front.

use crate::picture::camera::Window;
use crate::picture::lit_scene::LitScene;
use crate::picture::outline::{Point2, bounds, holds};

/// Number of samples along each side of the common area of two outlines.
const SIDE: usize = 6;

/// Lists the indices of solids from back to front, without those that have no outline.
///
/// The front one of two overlapping solids is the one that most rays through both hit first. In a cycle the farthest is first.
pub(crate) fn back_to_front(scene: &LitScene, view: &Window, outlines: &[Vec<Point2>]) -> Vec<usize> {
    let shown: Vec<usize> = (0..outlines.len()).filter(|i| outlines[*i].len() > 2).collect();
    let boxes: Vec<[Point2; 2]> = outlines.iter().map(|outline| bounds(outline)).collect();
    // The solids to draw before each.
    let mut before: Vec<Vec<usize>> = vec![Vec::new(); outlines.len()];
    for (k, a) in shown.iter().enumerate() {
        for b in &shown[k + 1..] {
            let low = [0, 1].map(|i| boxes[*a][0][i].max(boxes[*b][0][i]));
            let high = [0, 1].map(|i| boxes[*a][1][i].min(boxes[*b][1][i]));
            if low[0] >= high[0] || low[1] >= high[1] {
                continue;
            }
            let grid = (0..SIDE * SIDE).map(|i| {
                let share = |i: usize| (i as f64 + 0.5) / SIDE as f64;
                [low[0] + (high[0] - low[0]) * share(i % SIDE), low[1] + (high[1] - low[1]) * share(i / SIDE)]
            });
            // Thin overlaps are missed by a grid, but rarely by corners.
            let corners = outlines[*a].iter().chain(&outlines[*b]).copied();
            let both = grid.chain(corners).filter(|place| holds(&outlines[*a], *place) && holds(&outlines[*b], *place));
            match both.map(|place| nearer(scene, view, [*a, *b], place)).sum::<i32>() {
                0 => {}
                votes if votes > 0 => before[*a].push(*b),
                _ => before[*b].push(*a),
            }
        }
    }
    let far = |i: usize| view.depth(scene.solids[i].pose.position);
    let (mut left, mut order) = (shown, Vec::new());
    let mut drawn = vec![false; outlines.len()];
    while !left.is_empty() {
        let free = |i: &&usize| before[**i].iter().all(|behind| drawn[*behind]);
        let farthest = |a: &&usize, b: &&usize| far(**a).total_cmp(&far(**b)).then(b.cmp(a));
        let next = left.iter().filter(free).max_by(farthest).or_else(|| left.iter().max_by(farthest)).copied();
        let Some(next) = next else { break };
        left.retain(|i| *i != next);
        drawn[next] = true;
        order.push(next);
    }
    order
}

/// Returns 1 if the ray through a place hits the first of two solids first, -1 for the second, 0 unless it hits both.
fn nearer(scene: &LitScene, view: &Window, [a, b]: [usize; 2], place: Point2) -> i32 {
    let (origin, direction) = view.ray(place);
    let meets = |i| scene.see(origin, direction, [i]).is_some();
    match scene.see(origin, direction, [a, b]) {
        Some(seen) if meets(a) && meets(b) => {
            if seen.solid == a {
                1
            } else {
                -1
            }
        }
        _ => 0,
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::picture::camera::Camera;
    use crate::picture::moment::Picture;
    use crate::shape::appearance::{Instance, Role};
    use crate::shape::geometry::Geometry;
    use crate::shape::vector::Vector;
    use farsa_body::Pose;

    fn order(shapes: &[(Geometry, Vector)], camera: &str) -> Vec<usize> {
        let shapes =
            shapes.iter().map(|(geometry, at)| Instance::new(*geometry, Pose::at(*at), Role::Object)).collect();
        let picture = Picture { shapes, ..Picture::default() };
        let view = picture.window(Camera::named(camera).unwrap(), [300, 300]);
        let scene = LitScene::new(&picture, &view);
        let outlines: Vec<_> = scene.solids.iter().map(|solid| crate::picture::svg::outline(solid, &view)).collect();
        back_to_front(&scene, &view, &outlines)
    }

    #[test]
    fn the_nearer_box_comes_later() {
        let geometry = Geometry::Box { half: [0.1, 0.3, 0.2] };
        let [near, far] = [(geometry, [0.4, 0.1, 0.0]), (geometry, [-0.4, 0.0, 0.0])];
        assert_eq!(order(&[near, far], "front"), [1, 0]);
        assert_eq!(order(&[far, near], "front"), [0, 1]);
    }

    #[test]
    fn centres_do_not_decide() {
        // The middle of a long table is nearer to the eye than the ball at its far end.
        let table = (Geometry::Box { half: [1.0, 0.5, 0.05] }, [0.0, 0.0, -0.05]);
        let ball = (Geometry::Sphere { radius: 0.1 }, [-0.8, 0.0, 0.1]);
        assert_eq!(order(&[ball, table], "front"), [1, 0]);
        assert_eq!(order(&[table, ball], "three-quarter"), [0, 1]);
    }
}
