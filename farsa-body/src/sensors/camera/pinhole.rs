//! A pinhole camera: where it is, where its pixels look to, and where a point is in its image.

use alloc::vec;
use alloc::vec::Vec;

use farsa_num::{Scalar, sin_cos};

use crate::channel::{ChannelError, positive};
use crate::ports::{BodyId, Kinematics, Seen, Vision};
use crate::pose::Pose;
use crate::recorder::Recorder;

/// More pixels than this are not needed, and a mistake could run out of memory.
const MAX_PIXELS: usize = 1 << 20;

/// A pinhole camera on a body. Its own frame looks along x, with y to the left and z up. Its pixels are squares,
/// numbered row by row from the upper left.
///
/// A place (x, y, z) of its frame appears at (y, z) / (x w) in the image, with w the tangent of half the field of view.
/// The left edge is at 1, the right one at -1, and the vertical axis has the same unit.
#[derive(Clone, Debug, PartialEq)]
pub struct Camera<B = BodyId> {
    body: B,
    placement: Pose,
    size: [usize; 2],
    /// Tangent of half the field of view, w.
    tangent: f32,
    range: f32,
    /// Unit vectors of the pixels in the camera's frame, and in the world when it looked last.
    own: Vec<[f32; 3]>,
    rays: Vec<[f32; 3]>,
    seen: Vec<Option<Seen<B>>>,
}

impl<B: Copy> Camera<B> {
    /// Builds a camera on `body` at `placement` in that body's frame. The image has `size` [columns, rows], a
    /// horizontal field of view [rad] and a `range` [m].
    ///
    /// # Errors
    /// [`ChannelError::Groups`] for an image without pixels or of more than 2^20. [`ChannelError::Value`] for a field
    /// of view outside (0, pi), a `range` that is not a finite number > 0, or a placement that is not finite or has no
    /// unit quaternion.
    pub fn new(
        body: B,
        placement: Pose,
        size: [usize; 2],
        field_of_view: f64,
        range: f32,
    ) -> Result<Self, ChannelError> {
        let [columns, rows] = size;
        let pixels = columns.saturating_mul(rows);
        if pixels == 0 || pixels > MAX_PIXELS {
            return Err(ChannelError::Groups { field: "pixels", count: pixels, size: columns });
        }
        if !(field_of_view > 0.0 && field_of_view < core::f64::consts::PI) {
            return Err(ChannelError::Value { field: "field of view", value: field_of_view as f32 });
        }
        let length = placement.rotation.iter().fold(0.0, |sum, x| sum + x * x);
        if !length.is_finite() || (length - 1.0).abs() > 1e-3 {
            return Err(ChannelError::Value { field: "length of the rotation", value: length });
        }
        if let Some(value) = placement.position.into_iter().find(|x| !x.is_finite()) {
            return Err(ChannelError::Value { field: "place", value });
        }
        let (sine, cosine) = sin_cos(0.5 * field_of_view);
        let tangent = sine / cosine;
        let mut own = Vec::with_capacity(pixels);
        for row in 0..rows {
            for column in 0..columns {
                // The middle of the pixel. Pixels are square, so rows count in columns' widths.
                let left = tangent * (columns as f64 - 1.0 - 2.0 * column as f64) / columns as f64;
                let up = tangent * (rows as f64 - 1.0 - 2.0 * row as f64) / columns as f64;
                let length = Scalar::sqrt(1.0 + left * left + up * up);
                own.push([1.0, left, up].map(|x| (x / length) as f32));
            }
        }
        let (rays, seen) = (own.clone(), vec![None; pixels]);
        let (tangent, range) = (tangent as f32, positive("range", range)?);
        Ok(Self { body, placement, size, tangent, range, own, rays, seen })
    }

    /// The body it is on.
    pub fn body(&self) -> B {
        self.body
    }

    /// The image's [columns, rows].
    pub fn size(&self) -> [usize; 2] {
        self.size
    }

    /// Where the camera is in the world.
    pub fn pose<W: Kinematics<Body = B> + ?Sized>(&self, world: &W) -> Pose {
        world.pose(self.body).compose(&self.placement)
    }

    /// Returns the first surface of each pixel [rows x columns], the upper left first. The camera's own body is
    /// invisible.
    pub fn look<W: Kinematics<Body = B> + Vision + ?Sized>(&mut self, world: &W) -> &[Option<Seen<B>>] {
        let pose = self.pose(world);
        for (ray, own) in self.rays.iter_mut().zip(&self.own) {
            *ray = pose.rotate(*own);
        }
        world.look(pose.position, &self.rays, self.range, Some(self.body), &mut self.seen);
        &self.seen
    }

    /// Returns the color of each pixel at the last look, the upper left first.
    pub fn colors(&self) -> impl Iterator<Item = Option<[f32; 3]>> {
        self.seen.iter().map(|seen| seen.as_ref().and_then(|seen| seen.color))
    }

    /// Passes the image of the last look to a recorder under this number. It is black where there was no surface, or
    /// one without a color.
    pub fn record<R: Recorder + ?Sized>(&self, image: usize, recorder: &mut R) {
        for (pixel, color) in self.colors().enumerate() {
            recorder.pixel(image, pixel, color.unwrap_or_default());
        }
    }

    /// Where the middle of a pixel is in the image: to the left and upwards, in halves of its width.
    pub fn pixel(&self, index: usize) -> [f32; 2] {
        let [columns, rows] = self.size.map(|count| count as f32);
        let (column, row) = ((index % self.size[0]) as f32, (index / self.size[0]) as f32);
        [(columns - 1.0 - 2.0 * column) / columns, (rows - 1.0 - 2.0 * row) / columns]
    }

    /// Returns the position of a place of the world [m] in the image, to the left and upwards in halves of its width.
    /// It is beyond 1 outside of the image, and `None` for a place that is not in front of the camera.
    pub fn project(&self, pose: &Pose, place: [f32; 3]) -> Option<[f32; 2]> {
        let [ahead, left, up] = pose.transform_back(place);
        (ahead > 0.0).then(|| [left, up].map(|x| x / (ahead * self.tangent)))
    }
}
