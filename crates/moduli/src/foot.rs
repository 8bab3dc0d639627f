//! The plane on which an object stands where nothing else is known of it.

use nalgebra::UnitVector3;
use shape::Support;

use crate::object::Object;

/// The surface is looked at on this many circles of latitude, with twice as many points each.
const ROWS: usize = 121;

impl Object {
    /// The plane through the lowest point of the surface along an upward direction, in the frame of the
    /// cloud.
    ///
    /// ```
    /// use moduli::{Object, RadialShape, nalgebra::Vector3};
    ///
    /// let ball = Object::from_shape("ball", RadialShape::sphere(3, 0.04)?);
    /// let foot = ball.foot(&Vector3::z_axis());
    /// assert!((foot.offset_m + 0.04).abs() < 1e-9);
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    pub fn foot(&self, up: &UnitVector3<f64>) -> Support {
        let vertices = self.shape().mesh(ROWS, 2 * ROWS - 2).vertices;
        let heights = vertices.iter().map(|v| up.dot(&v.coords));
        let centred = Support {
            normal: *up,
            offset_m: heights.fold(f64::INFINITY, f64::min),
        };
        self.frame().plane_to_cloud(&centred)
    }
}
