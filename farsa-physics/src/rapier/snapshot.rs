//! rapier's whole state as numbers: three bytes in each, so that every one of them is a whole number and none a NaN.

use alloc::vec::Vec;

use farsa_num::crc32;
use rapier3d::pipeline::PhysicsWorld;

/// Words before the bytes: number of bytes (two words), their checksum (two), two flags.
const HEAD: usize = 5;

/// Bytes in a word.
const BYTES: usize = 3;

/// The content of a snapshot.
pub(crate) struct Kept {
    pub(crate) physics: PhysicsWorld,
    pub(crate) commands: Vec<[f32; 2]>,
    pub(crate) lost: bool,
    pub(crate) moved: bool,
}

fn bytes_of(physics: &PhysicsWorld, commands: &[[f32; 2]]) -> Vec<u8> {
    // Only a map of unknown length or a format without one can fail, rapier's state has none.
    postcard::to_allocvec(&(physics, commands)).unwrap_or_default()
}

/// The snapshot's words.
pub(crate) fn pack(physics: &PhysicsWorld, commands: &[[f32; 2]], [lost, moved]: [bool; 2]) -> Vec<f32> {
    let bytes = bytes_of(physics, commands);
    let mut words = Vec::with_capacity(HEAD + bytes.len().div_ceil(BYTES));
    let checksum = crc32(&bytes);
    let length = bytes.len() as u32;
    for whole in
        [length >> 16, length & 0xffff, checksum >> 16, checksum & 0xffff, u32::from(lost) | u32::from(moved) << 1]
    {
        words.push(whole as f32);
    }
    words.extend(bytes.chunks(BYTES).map(|chunk| {
        let whole = chunk.iter().rev().fold(0_u32, |sum, byte| sum << 8 | u32::from(*byte));
        whole as f32
    }));
    words
}

/// Returns the content that [`pack`] has packed, or `None` if it is damaged.
pub(crate) fn unpack(words: &[f32]) -> Option<Kept> {
    let (head, body) = words.split_at_checked(HEAD)?;
    let whole = |k: usize| head[k] as u32;
    let length = (whole(0) << 16 | whole(1)) as usize;
    let body = body.get(..length.div_ceil(BYTES))?;
    let mut bytes: Vec<u8> =
        body.iter().flat_map(|word| (*word as u32).to_le_bytes().into_iter().take(BYTES)).collect();
    bytes.truncate(length);
    if crc32(&bytes) != (whole(2) << 16 | whole(3)) {
        return None;
    }
    let (physics, commands) = postcard::from_bytes(&bytes).ok()?;
    Some(Kept { physics, commands, lost: whole(4) & 1 != 0, moved: whole(4) & 2 != 0 })
}

/// Returns a copy of rapier's state with its own workspaces.
pub(crate) fn copy(physics: &PhysicsWorld) -> PhysicsWorld {
    PhysicsWorld {
        gravity: physics.gravity,
        integration_parameters: physics.integration_parameters,
        islands: physics.islands.clone(),
        broad_phase: physics.broad_phase.clone(),
        narrow_phase: physics.narrow_phase.clone(),
        bodies: physics.bodies.clone(),
        colliders: physics.colliders.clone(),
        impulse_joints: physics.impulse_joints.clone(),
        multibody_joints: physics.multibody_joints.clone(),
        soft_bodies: physics.soft_bodies.clone(),
        ..PhysicsWorld::new()
    }
}
