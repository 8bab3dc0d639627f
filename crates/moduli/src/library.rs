//! The library of known objects, and the transfer of their grasps to a new object (Sec. IV-E).

use std::sync::OnceLock;

use hand::{Hand, HandState, carried_pose};
use rayon::prelude::*;
use record::{LibraryEntry, LibraryGrasp, LibraryRecord};
use shape::{AnyShape, RadialShape};
use space::point::contacts_on;
use space::{Continuation, Transfer, TransferEnd, distance_of};
use sph::{Coefficients, Direction};

use crate::carried::{CarriedGrasp, best};
use crate::error::Error;
use crate::grasp::{Grasps, Source};
use crate::hands::{HandSearch, give_hands};
use crate::measure::Measure;
use crate::object::Object;
use crate::records::{StoredShapeError, stored_coefficients};

/// Known objects with their best grasps.
#[derive(Clone, Debug, Default)]
pub struct Library {
    builtin: bool,
    own: Vec<LibraryRecord>,
}

/// Options of the transfer from a library.
#[derive(Clone, Debug, PartialEq)]
pub struct TransferOptions {
    /// Number of nearest known objects from which grasps are transferred.
    pub neighbours: usize,
    /// Number of grasps transferred from each, the best first.
    pub grasps: usize,
    /// Number of best transferred grasps that are kept and for which a hand is searched.
    pub keep: usize,
    /// Options of the search for a hand.
    pub search: HandSearch,
}

impl Default for TransferOptions {
    /// Four grasps from each of the three nearest objects, of which the best twelve are kept.
    fn default() -> Self {
        Self {
            neighbours: 3,
            grasps: 4,
            keep: 12,
            search: HandSearch::default(),
        }
    }
}

/// A known object near the object to be grasped.
#[derive(Clone, Debug)]
pub struct Neighbour {
    /// Id and name.
    pub name: String,
    /// Distance d of the shapes (Sec. III-A), metres.
    pub distance: f64,
    object: Object,
    pub(crate) grasps: Vec<LibraryGrasp>,
    /// Name of the hand that made the grasps.
    hand: String,
}

impl Neighbour {
    /// Name of the object, and distance of the shapes in metres.
    pub(crate) fn described(&self) -> (String, f64) {
        (self.name.clone(), self.distance)
    }
}

impl Library {
    /// The built-in library: twelve objects with grasps of the Schunk SDH.
    pub fn builtin() -> &'static Self {
        static BUILTIN: Library = Library {
            builtin: true,
            own: Vec::new(),
        };
        &BUILTIN
    }

    /// A library read from a file's bytes.
    ///
    /// # Errors
    /// The bytes are not a library.
    pub fn from_bytes(bytes: &[u8]) -> Result<Self, Error> {
        Ok(Self::from_record(LibraryRecord::from_bytes(bytes)?))
    }

    /// A library of the given objects.
    pub fn from_record(record: LibraryRecord) -> Self {
        Self::default().with(record)
    }

    /// Adds the objects of a record, which may contain grasps of another hand.
    #[must_use]
    pub fn with(mut self, record: LibraryRecord) -> Self {
        self.own.push(record);
        self
    }

    /// The stored objects: one record per call of [`Library::with`], after the built-in record if
    /// the library began with it. The built-in record is decoded once per process.
    ///
    /// # Errors
    /// The bytes of the built-in library are damaged.
    pub fn records(&self) -> Result<Vec<&LibraryRecord>, Error> {
        static BUILTIN: OnceLock<LibraryRecord> = OnceLock::new();
        let mut records = Vec::with_capacity(1 + self.own.len());
        if self.builtin {
            let decoded = match BUILTIN.get() {
                Some(decoded) => decoded,
                None => {
                    let record = LibraryRecord::from_bytes(fixtures::LIBRARY)?;
                    BUILTIN.get_or_init(|| record)
                }
            };
            records.push(decoded);
        }
        records.extend(&self.own);
        Ok(records)
    }

    /// The known objects nearest to an object by d (Sec. III-A), the nearest first.
    ///
    /// For an object whose surface is a map f of the sphere, d is the L² distance of maps after the known
    /// surface r p has been turned by the rotation of its parameters under which it is most like f.
    ///
    /// # Errors
    /// An entry is damaged.
    pub fn nearest(&self, object: &Object, count: usize) -> Result<Vec<Neighbour>, Error> {
        let damaged = |entry: &LibraryEntry, error| Error::LibraryShape {
            object: entry.id.clone(),
            error,
        };
        let mut order = Vec::new();
        for record in self.records()? {
            for entry in &record.entries {
                let other = stored_coefficients(&entry.shape).map_err(|e| damaged(entry, e))?;
                let distance = distance(object, &other).map_err(|e| damaged(entry, e))?;
                order.push((entry, &record.hand, distance));
            }
        }
        order.sort_by(|a, b| a.2.total_cmp(&b.2));
        order
            .into_par_iter()
            .take(count)
            .map(|(entry, hand, distance)| {
                let object = Object::from_record(&entry.shape).map_err(|error| match error {
                    Error::Stored(error) => damaged(entry, error),
                    other => other,
                })?;
                object.field();
                Ok(Neighbour {
                    name: format!("{} {}", entry.id, entry.name),
                    distance,
                    object: object.named(&entry.id),
                    grasps: entry.grasps.clone(),
                    hand: hand.clone(),
                })
            })
            .collect()
    }

    /// Transfers the best grasps of the nearest known objects to the object of `measure`, and
    /// searches a pose of `hand` for each.
    ///
    /// # Errors
    /// An entry is damaged, or a transfer or a quality cannot be computed.
    pub fn transfer_to(&self, measure: &Measure<'_>, hand: &Hand) -> Result<Grasps, Error> {
        let options = TransferOptions::default();
        let neighbours = self.nearest(measure.object(), options.neighbours)?;
        let carried = carry(measure, hand, &neighbours, options.grasps, &|| {})?;
        let mut kept = best(carried, options.keep);
        give_hands(measure, hand, &mut kept, &options.search, &|| {})?;
        Ok(Grasps {
            list: kept.into_iter().map(|c| c.grasp).collect(),
            outcomes: None,
        })
    }
}

/// Transfers the first `grasps` grasps of every neighbour to the object of `measure`, on rayon's
/// thread pool. Grasps whose number of contacts differs from the hand's number of fingers are left
/// out. `done` is called once per grasp.
pub(crate) fn carry(
    measure: &Measure<'_>,
    hand: &Hand,
    neighbours: &[Neighbour],
    grasps: usize,
    done: &(dyn Fn() + Sync),
) -> Result<Vec<CarriedGrasp>, Error> {
    let to = end(measure.object());
    let pairs: Vec<Transfer> = neighbours
        .iter()
        .map(|n| Transfer::new(end(&n.object), to, measure.rule()))
        .collect();
    let mut jobs = Vec::new();
    for (neighbour, pair) in neighbours.iter().zip(&pairs) {
        for (index, grasp) in neighbour.grasps.iter().enumerate().take(grasps) {
            let directions = grasp.directions().ok_or_else(|| Error::LibraryGrasp {
                object: neighbour.object.name().to_owned(),
                grasp: index,
            })?;
            if directions.len() == hand.fingers().len() {
                jobs.push((neighbour, pair, grasp, directions));
            }
        }
    }
    jobs.into_par_iter()
        .map(|(neighbour, pair, grasp, directions)| {
            let carried = carry_one(measure, hand, pair, neighbour, grasp, &directions);
            done();
            carried.map_err(|error| Error::Transfer {
                from: neighbour.object.name().to_owned(),
                error,
            })
        })
        .collect()
}

/// d between an object and a known radius.
fn distance(object: &Object, other: &Coefficients) -> Result<f64, StoredShapeError> {
    match object.shape().radial() {
        Some(shape) => Ok(shape.coefficients().distance(other)),
        None => {
            let known = AnyShape::from(RadialShape::new(other.clone())?);
            Ok(distance_of(object.field(), &known.field()))
        }
    }
}

fn end(object: &Object) -> TransferEnd<'_> {
    TransferEnd {
        surface: object.field(),
        object_origin: object.frame().cloud_origin(),
    }
}

fn carry_one(
    measure: &Measure<'_>,
    hand: &Hand,
    pair: &Transfer,
    neighbour: &Neighbour,
    grasp: &LibraryGrasp,
    directions: &[Direction],
) -> Result<CarriedGrasp, space::TransferError> {
    let arrived = Continuation::default().carry(pair, directions)?;
    let naive = pair.naive(directions)?.quality;
    let contacts = contacts_on(pair.target(), &arrived.directions);
    let held = contacts_on(pair.source(), directions);
    // Poses and joints of another hand do not apply to this one.
    let same_hand = neighbour.hand == hand.name();
    let state = same_hand.then(|| HandState {
        object_from_palm: carried_pose(&grasp.centred_from_palm(), &held, &contacts),
        joints: grasp.joints_rad.clone(),
    });
    let source = Source::Transfer {
        from: neighbour.name.clone(),
        shape_distance: neighbour.distance,
        source_quality: grasp.quality,
        naive,
    };
    Ok(CarriedGrasp {
        grasp: measure.grasp_of(arrived.directions, contacts, arrived.quality, source)?,
        hand: state,
    })
}
