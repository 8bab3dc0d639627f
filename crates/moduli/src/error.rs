//! The error type of all steps from a scan to grasps.

use crate::records::StoredShapeError;

/// Why a step from a scan to grasps failed.
///
/// Each variant contains the error of the crate that failed, with the index and the value at fault.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum Error {
    /// The bytes are not a cloud or a mesh.
    #[error(transparent)]
    Load(#[from] shape::io::LoadError),
    /// The points are not a usable cloud.
    #[error(transparent)]
    Cloud(#[from] shape::CloudError),
    /// The cloud is not clearly one object.
    #[error(transparent)]
    Scene(#[from] shape::SceneError),
    /// The surface does not explain its points.
    #[error("{}", notes.join("; "))]
    Unexplained {
        /// What is to be said of the scene and of the surface, a sentence each.
        notes: Vec<String>,
    },
    /// The cloud has neither a radial surface nor a map of the sphere.
    #[error("{radial}; nor does a map of the sphere describe the points: {spherical}")]
    NeitherModel {
        /// Why no radius describes the points.
        radial: Box<Error>,
        /// Why no map does.
        spherical: Box<Error>,
    },
    /// The cloud has no proved surface.
    #[error(transparent)]
    Fit(#[from] shape::FitError),
    /// Points with sphere coordinates have no proved surface.
    #[error(transparent)]
    SphericalFit(#[from] shape::SphericalFitError),
    /// The cloud has no proved surface over the sphere.
    #[error(transparent)]
    SphericalCloud(#[from] shape::SphericalCloudError),
    /// Another number of directions than of points.
    #[error("{directions} directions for {points} points; expected one direction per point")]
    DirectionCount {
        /// The directions given.
        directions: usize,
        /// The points of the cloud.
        points: usize,
    },
    /// A stored shape or library is damaged.
    #[error(transparent)]
    Stored(#[from] StoredShapeError),
    /// The bytes are not a record of moduli.
    #[error(transparent)]
    Record(#[from] record::EnvelopeError),
    /// The name is not that of a convention.
    #[error(transparent)]
    UnknownConvention(#[from] grasp::UnknownConvention),
    /// A number of the convention is out of range.
    #[error(transparent)]
    Convention(#[from] grasp::ConventionError),
    /// A quality cannot be computed.
    #[error(transparent)]
    Quality(#[from] grasp::QualityError),
    /// The wrenches of a grasp cannot be computed.
    #[error(transparent)]
    Wrench(#[from] grasp::WrenchError),
    /// Grasps of the hand cannot be sampled on the object.
    #[error(transparent)]
    Synthesis(#[from] hand::SynthesisError),
    /// The hand cannot be used.
    #[error(transparent)]
    Hand(#[from] hand::LoadError),
    /// An ascent has no result.
    #[error(transparent)]
    Ascent(#[from] space::AscentError),
    /// A transfer has no result.
    #[error("transfer from {from}: {error}")]
    Transfer {
        /// The object from which grasps were carried.
        from: String,
        /// Why they did not arrive.
        error: space::TransferError,
    },
    /// A grasp of the library is damaged.
    #[error("library object {object}, grasp {grasp}: a direction is not a unit vector")]
    LibraryGrasp {
        /// The object's id.
        object: String,
        /// Index of the grasp.
        grasp: usize,
    },
    /// A shape of the library is damaged.
    #[error("library object {object}: {error}")]
    LibraryShape {
        /// The object's id.
        object: String,
        /// What is wrong with it.
        error: StoredShapeError,
    },
    /// A contact has no direction from the centre of the object.
    #[error(
        "contact {contact} is at ({}, {}, {}) m; expected finite coordinates away from the centre of {object}",
        position[0], position[1], position[2]
    )]
    Contact {
        /// Name of the object.
        object: String,
        /// Index of the contact.
        contact: usize,
        /// The position given, in the frame of the cloud, metres.
        position: [f64; 3],
    },
}
