//! Framing of a 3-D view: equal scales on all axes, and a camera that shows the subject.

use plotly::common::Title;
use plotly::layout::{
    AspectMode, AspectRatio, Axis, AxisRange, Camera, CameraCenter, DragMode3D, Eye, LayoutScene,
    Projection, ProjectionType, Up,
};

use crate::mesh::Extent;
use crate::text;
use crate::theme;

/// Direction from the subject to the camera in perspective views: from the right, front and above.
pub(crate) const EYE_DIRECTION: [f64; 3] = [0.56, -0.72, 0.41];
/// Direction to the camera of a flat view: almost exactly from the front.
const FRONT_DIRECTION: [f64; 3] = [0.0, -0.97, 0.24];

/// The content of a view.
pub(crate) struct View<'a> {
    /// The box of everything that can be drawn; plotly.js clips to it.
    pub(crate) bounds: Extent,
    /// The box that the camera looks at and that fills the initial picture.
    pub(crate) subject: Extent,
    /// Axis titles; `None` draws no axes.
    pub(crate) axes: Option<[&'a str; 3]>,
    /// Perspective, or parallel projection from the front.
    pub(crate) projection: ViewProjection,
}

/// The projection of a view.
#[derive(Clone, Copy, PartialEq)]
pub(crate) enum ViewProjection {
    /// Perspective, from a distance at which the subject fits.
    Perspective {
        /// Direction to the camera, a unit vector.
        from: [f64; 3],
    },
    /// Parallel and from the front (−y).
    Front {
        /// Height over width of the picture.
        shape: f64,
    },
}

impl View<'_> {
    /// The scene, with equal scales along x, y and z.
    pub(crate) fn scene(&self) -> LayoutScene {
        let unit = self.unit();
        let [width, depth, height] = self.bounds.size().map(|s| s / unit);
        LayoutScene::new()
            .aspect_mode(AspectMode::Manual)
            .aspect_ratio(AspectRatio::new().x(width).y(depth).z(height))
            .drag_mode(DragMode3D::Orbit)
            .camera(self.camera(unit))
            .x_axis(self.axis(0))
            .y_axis(self.axis(1))
            .z_axis(self.axis(2))
    }

    /// The length that is 1 in the coordinates of the camera.
    fn unit(&self) -> f64 {
        let [width, _, height] = self.bounds.size();
        let unit = match self.projection {
            ViewProjection::Perspective { .. } => self.bounds.longest(),
            // A parallel view of plotly.js is 2 units high and 2/shape wide, independent of the
            // camera's distance. The colour bar takes part of the width.
            ViewProjection::Front { shape } => (height / 1.95).max(width * shape / 1.75),
        };
        unit.max(f64::MIN_POSITIVE)
    }

    fn camera(&self, unit: f64) -> Camera {
        let projection = match self.projection {
            ViewProjection::Perspective { .. } => ProjectionType::Perspective,
            ViewProjection::Front { .. } => ProjectionType::Orthographic,
        };
        let [eye, centre] = self.eye_and_centre(unit);
        Camera::new()
            .center(CameraCenter::from((centre[0], centre[1], centre[2])))
            .eye(Eye::from((eye[0], eye[1], eye[2])))
            .up(Up::from((0.0, 0.0, 1.0)))
            .projection(Projection::new().projection_type(projection))
    }

    /// Position and target of the camera, as JSON for a script.
    pub(crate) fn camera_json(&self) -> String {
        let [eye, centre] = self.eye_and_centre(self.unit());
        let point = |p: [f64; 3]| format!("{{\"x\":{},\"y\":{},\"z\":{}}}", p[0], p[1], p[2]);
        format!("{{\"eye\":{},\"center\":{}}}", point(eye), point(centre))
    }

    /// Eye and centre in coordinates of the camera.
    fn eye_and_centre(&self, unit: f64) -> [[f64; 3]; 2] {
        let middle = self.bounds.centre();
        let target = self.subject.centre();
        let centre: [f64; 3] = std::array::from_fn(|i| (target[i] - middle[i]) / unit);
        let (direction, distance) = match self.projection {
            ViewProjection::Perspective { from } => (from, 1.55 * self.subject.diagonal() / unit),
            ViewProjection::Front { .. } => (FRONT_DIRECTION, 2.0 * self.bounds.diagonal() / unit),
        };
        let eye = std::array::from_fn(|i| centre[i] + distance * direction[i]);
        [eye, centre]
    }

    fn axis(&self, k: usize) -> Axis {
        let axis = Axis::new().range(AxisRange::new(self.bounds.low[k], self.bounds.high[k]));
        match self.axes {
            None => axis.visible(false),
            Some(titles) => axis
                .title(Title::with_text(text::plot(titles[k])).font(theme::muted_font()))
                .tick_font(theme::muted_font())
                .n_ticks(6)
                .grid_color(theme::GRID)
                .line_color(theme::RULE)
                .zero_line(false)
                .show_spikes(false),
        }
    }
}
