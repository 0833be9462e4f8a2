//! The ports of a world of wheeled robots in rapier.

use farsa_body::ports::{
    Actuated, ActuatorId, Arrange, BodyId, Contacts, ExternalForces, Handles, Hit, JointId, Joints, Kinematics, Lamp,
    NearbySurface, PairContact, PairId, Planar, PlanarHit, Rays, Sight, Snapshot,
};
use farsa_body::{Pose, Twist};
use farsa_num::Scalar;
use rapier3d::geometry::Ray;

use crate::arena::surface::{ray_to_wall, to_wall};
use crate::arena::view;
use crate::rapier::arena_world::ArenaWorld;
use crate::rapier::snapshot::{Kept, pack, unpack};

/// Words of a pair in a snapshot: the other body plus one, or 0. Then its contact.
const PAIR_WORDS: usize = 10;

impl Handles for ArenaWorld {
    type Body = BodyId;
    type Joint = JointId;
    type Actuator = ActuatorId;
}

impl farsa_body::ports::World for ArenaWorld {
    fn step(&mut self) {
        self.advance();
    }
    fn time_step(&self) -> f32 {
        self.model.time_step
    }
}

impl Kinematics for ArenaWorld {
    fn pose(&self, body: BodyId) -> Pose {
        if body.index() < self.plan.vehicles.len() {
            return self.robot_pose(body.index());
        }
        self.block_of(body).map_or_else(|| view::pose(self, body), |block| self.block_pose(block))
    }
    fn velocity(&self, body: BodyId) -> Twist {
        if body.index() < self.plan.vehicles.len() {
            return self.robot_velocity(body.index());
        }
        self.block_of(body).map_or_else(Twist::default, |block| self.block_velocity(block))
    }
}

impl ExternalForces for ArenaWorld {
    fn apply_force(&mut self, body: BodyId, point: [f32; 3], force: [f32; 3]) {
        self.push(body, point, force);
    }
}

impl Joints for ArenaWorld {
    fn position(&self, joint: JointId) -> f32 {
        view::joint_position(self, joint)
    }
    fn speed(&self, joint: JointId) -> f32 {
        view::joint_speed(self, joint)
    }
}

impl Actuated for ArenaWorld {
    fn command(&mut self, actuator: ActuatorId, value: [f32; 2]) {
        view::command(self, actuator, value[0]);
    }
}

impl Contacts for ArenaWorld {
    fn pairs(&self) -> usize {
        self.met.len()
    }
    fn pair_bodies(&self, pair: PairId) -> [Option<BodyId>; 2] {
        let robots = self.plan.vehicles.len();
        let body = |pair: usize| if pair < robots { pair } else { self.model.bodies() + pair - robots };
        let contact = self.met.get(pair.index());
        contact.map_or([None; 2], |(other, _)| [Some(BodyId(body(pair.index()) as u16)), *other])
    }
    fn pair_contact(&self, pair: PairId) -> PairContact {
        self.met.get(pair.index()).map_or_else(PairContact::default, |(_, contact)| *contact)
    }
}

impl Rays for ArenaWorld {
    fn cast(&self, origin: [f32; 3], direction: [f32; 3], range: f32) -> Option<Hit<BodyId>> {
        let mut hit = view::cast(self, origin, direction, range);
        let ray = Ray::new(origin.into(), direction.into());
        for (block, parcel) in self.plan.parcels.iter().enumerate() {
            let Some(collider) = self.physics.colliders.get(parcel.collider) else { continue };
            let reach = hit.map_or(range, |hit| hit.distance);
            let met = collider.shape().cast_ray_and_get_normal(collider.position(), &ray, reach, false);
            if let Some(met) = met.filter(|met| met.normal.dot(ray.dir) <= 0.0 && met.time_of_impact < reach) {
                let body = BodyId((self.model.bodies() + block) as u16);
                hit = Some(Hit { distance: met.time_of_impact, normal: met.normal.into(), body: Some(body) });
            }
        }
        hit
    }
}

impl Sight for ArenaWorld {
    fn query_near(&self, from: [f32; 2], range: f32, tell: &mut dyn FnMut(NearbySurface<BodyId>)) {
        view::query_near(self, from, range, &mut *tell);
        for (block, slab) in self.slabs.iter().enumerate().filter(|(_, slab)| slab.within_reach(from, range)) {
            let [x, y] = to_wall(slab, from);
            let distance = Scalar::sqrt(x * x + y * y);
            if distance <= range {
                tell(NearbySurface {
                    body: Some(BodyId((self.model.bodies() + block) as u16)),
                    point: [from[0] + x, from[1] + y],
                    distance,
                    radius: 0.0,
                    color: slab.color,
                    signal: None,
                });
            }
        }
    }
    fn cast_planar(
        &self,
        from: [f32; 2],
        direction: [f32; 2],
        range: f32,
        but: Option<BodyId>,
    ) -> Option<PlanarHit<BodyId>> {
        let mut sight = view::cast_planar(self, from, direction, range, but);
        for (block, slab) in self.slabs.iter().enumerate() {
            let body = BodyId((self.model.bodies() + block) as u16);
            if but != Some(body)
                && let Some(distance) = ray_to_wall(slab, from, direction)
                && sight.as_ref().map_or(distance <= range, |sight| distance < sight.distance)
            {
                sight = Some(PlanarHit { distance, body: Some(body), color: slab.color });
            }
        }
        sight
    }
}

impl Planar for ArenaWorld {
    fn ground(&self, at: [f32; 2]) -> [f32; 3] {
        view::ground(self, at)
    }
    fn lamps(&self, tell: &mut dyn FnMut(Lamp<BodyId>)) {
        view::lamps(self, tell);
    }
}

fn pair_words((other, contact): &(Option<BodyId>, PairContact)) -> [f32; PAIR_WORDS] {
    let PairContact { points, force: [u, v, w], normal_force, point: [x, y, z], depth } = *contact;
    let other = other.map_or(0.0, |body| f32::from(body.0) + 1.0);
    [other, points as f32, u, v, w, normal_force, x, y, z, depth]
}

fn pair_of(words: &[f32]) -> (Option<BodyId>, PairContact) {
    let [other, points, u, v, w, normal_force, x, y, z, depth] = *words else {
        return (None, PairContact::default());
    };
    let body = (other >= 1.0).then_some(BodyId((other - 1.0) as u16));
    (body, PairContact { points: points as u32, force: [u, v, w], normal_force, point: [x, y, z], depth })
}

impl Snapshot for ArenaWorld {
    /// rapier's state has no fixed length: ask right before saving.
    fn snapshot_len(&self) -> usize {
        let packed = pack(&self.physics, &[], [self.lost, self.moved]).len();
        self.words.len() + PAIR_WORDS * self.met.len() + packed
    }
    fn save(&self, out: &mut [f32]) {
        let pairs = self.met.iter().flat_map(pair_words);
        let packed = pack(&self.physics, &[], [self.lost, self.moved]);
        for (o, word) in out.iter_mut().zip(self.words.iter().copied().chain(pairs).chain(packed)) {
            *o = word;
        }
    }
    /// Words that are damaged, or were saved by a world of another description, break the world down.
    fn restore(&mut self, from: &[f32]) {
        self.pushes.clear();
        let (words, pairs) = (self.words.len(), PAIR_WORDS * self.met.len());
        let snapshot = from.get(words + pairs..).and_then(unpack).filter(|snapshot| self.fits(&snapshot.physics));
        if let Some(Kept { physics, lost, moved, .. }) = snapshot {
            (self.physics, self.lost, self.moved) = (physics, lost, moved);
            self.words.copy_from_slice(&from[..words]);
            for (met, words) in self.met.iter_mut().zip(from[words..].chunks_exact(PAIR_WORDS)) {
                *met = pair_of(words);
            }
        } else {
            self.lost = true;
        }
        self.look_again();
    }
}

impl Arrange for ArenaWorld {
    fn clear(&mut self) {
        view::clear(self);
        self.reset();
    }
    fn place_joint(&mut self, joint: JointId, position: f32, speed: f32) {
        view::place_joint(self, joint, position, speed);
        self.put_wheel(joint, position, speed);
    }
    fn place_body(&mut self, body: BodyId, pose: Pose, _: Twist) {
        view::place_body(self, body, pose);
        self.put_body(body, &pose);
    }
    fn finish_placement(&mut self) {
        self.settle();
    }
}
