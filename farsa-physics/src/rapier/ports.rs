//! The ports of a world of rapier.

use farsa_body::ports::{
    Actuated, ActuatorId, Arrange, BodyId, Contacts, ExternalForces, Handles, Hit, JointId, Joints, Kinematics,
    PairContact, PairId, Rays, Seen, Snapshot, Vision,
};
use farsa_body::{Pose, Twist};
use rapier3d::geometry::Ray;

use crate::rapier::contact::{pair_contact, touches};
use crate::rapier::rules::Rules;
use crate::rapier::snapshot::{Kept, pack, unpack};
use crate::rapier::world::World;

impl Handles for World {
    type Body = BodyId;
    type Joint = JointId;
    type Actuator = ActuatorId;
}

impl farsa_body::ports::World for World {
    fn step(&mut self) {
        self.advance();
    }
    fn time_step(&self) -> f32 {
        self.plan.time_step
    }
}

impl Kinematics for World {
    fn pose(&self, body: BodyId) -> Pose {
        self.pose_of(body)
    }
    fn velocity(&self, body: BodyId) -> Twist {
        self.velocity_of(body)
    }
}

impl Joints for World {
    fn position(&self, joint: JointId) -> f32 {
        self.joint_state(joint)[0]
    }
    fn speed(&self, joint: JointId) -> f32 {
        self.joint_state(joint)[1]
    }
}

impl Actuated for World {
    fn command(&mut self, actuator: ActuatorId, value: [f32; 2]) {
        if let Some(command) = self.commands.get_mut(actuator.index()) {
            *command = value;
        }
    }
}

impl ExternalForces for World {
    fn apply_force(&mut self, body: BodyId, point: [f32; 3], force: [f32; 3]) {
        self.push(body, point, force);
    }
}

impl Contacts for World {
    fn pairs(&self) -> usize {
        self.plan.pairs.len()
    }
    fn pair_bodies(&self, pair: PairId) -> [Option<BodyId>; 2] {
        self.plan.pairs.get(pair.index()).map_or([None; 2], |pair| pair.bodies)
    }
    fn pair_contact(&self, pair: PairId) -> PairContact {
        self.plan.pairs.get(pair.index()).map_or_else(PairContact::default, |pair| pair_contact(&self.physics, pair))
    }
    fn touches(&self, pair: PairId) -> bool {
        self.plan.pairs.get(pair.index()).is_some_and(|pair| touches(&self.physics, pair))
    }
}

impl World {
    /// The first surface on a ray, except those of `but`, and the number of its collider.
    ///
    /// Surfaces are met from outside only, as in the other worlds: what the ray begins in is not seen.
    fn first(
        &self,
        origin: [f32; 3],
        direction: [f32; 3],
        range: f32,
        but: Option<BodyId>,
    ) -> Option<(Hit<BodyId>, Option<usize>)> {
        let ray = Ray::new(origin.into(), direction.into());
        let mut nearest: Option<(Hit<BodyId>, Option<usize>)> = None;
        for (_, collider) in self.physics.all_colliders() {
            let number = Rules::number(collider);
            let body = number.and_then(|c| self.plan.collider_bodies.get(c).copied().flatten());
            if but.is_some() && body == but {
                continue;
            }
            let reach = nearest.map_or(range, |(hit, _)| hit.distance);
            let met = collider.shape().cast_ray_and_get_normal(collider.position(), &ray, reach, false);
            let Some(met) = met.filter(|met| met.normal.dot(ray.dir) <= 0.0 && met.time_of_impact < reach) else {
                continue;
            };
            let hit = Hit { distance: met.time_of_impact, normal: met.normal.into(), body };
            nearest = Some((hit, number));
        }
        nearest
    }
}

impl Rays for World {
    fn cast(&self, origin: [f32; 3], direction: [f32; 3], range: f32) -> Option<Hit<BodyId>> {
        self.first(origin, direction, range, None).map(|(hit, _)| hit)
    }
}

impl Vision for World {
    fn look(
        &self,
        from: [f32; 3],
        directions: &[[f32; 3]],
        range: f32,
        but: Option<BodyId>,
        seen: &mut [Option<Seen<BodyId>>],
    ) {
        for (seen, direction) in seen.iter_mut().zip(directions) {
            *seen = self.first(from, *direction, range, but).map(|(Hit { distance, body, .. }, number)| {
                let color = number.and_then(|number| self.plan.colors.get(number).copied().flatten());
                Seen { distance, body, color }
            });
        }
    }
}

impl Snapshot for World {
    /// rapier's state has no fixed length: ask right before saving.
    fn snapshot_len(&self) -> usize {
        pack(&self.physics, &self.commands, [self.lost, self.moved]).len()
    }
    fn save(&self, out: &mut [f32]) {
        for (o, word) in out.iter_mut().zip(pack(&self.physics, &self.commands, [self.lost, self.moved])) {
            *o = word;
        }
    }
    /// Words that are damaged, or were saved by a world of another description, break the world down.
    fn restore(&mut self, from: &[f32]) {
        self.pushes.clear();
        match unpack(from).filter(|snapshot| self.fits(snapshot)) {
            Some(Kept { physics, commands, lost, moved }) => {
                (self.physics, self.commands, self.lost, self.moved) = (physics, commands, lost, moved);
            }
            None => self.lost = true,
        }
    }
}

impl Arrange for World {
    fn clear(&mut self) {
        self.reset();
    }
    fn place_joint(&mut self, joint: JointId, position: f32, speed: f32) {
        self.put_joint(joint, position, speed);
    }
    fn place_body(&mut self, body: BodyId, pose: Pose, twist: Twist) {
        self.put_body(body, pose, twist);
    }
    fn finish_placement(&mut self) {
        self.settle();
    }
}
