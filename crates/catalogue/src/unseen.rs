//! Two objects that are not in the library and represent unknown objects.

use crate::object::CatalogueObject;
use crate::solid::Solid;

/// U1 and U2 in this order.
pub(crate) fn build() -> Vec<CatalogueObject> {
    vec![honey_bear(), detergent_bottle()]
}

/// A sitting bear as a squeeze bottle: belly, paws, head with snout and ears, pointed cap.
fn honey_bear() -> CatalogueObject {
    let belly = Solid::ellipsoid(0.038, 0.036, 0.048).at(0.0, 0.0, 0.043);
    let head = Solid::ball(0.029).at(0.0, 0.0, 0.097);
    let snout = Solid::ellipsoid(0.012, 0.012, 0.010)
        .turned(0.0, -0.7, 0.0)
        .at(0.022, 0.0, 0.096);
    let cap = Solid::frustum((0.020, 0.105), (0.010, 0.150), 0.004);
    let mut bear = belly.with(head, 0.016).with(snout, 0.006).with(cap, 0.006);
    for side in [-1.0, 1.0] {
        let ear = Solid::ball(0.0095).at(0.0, side * 0.020, 0.1155);
        let paw = Solid::ball(0.013).at(0.023, side * 0.020, 0.060);
        let foot = Solid::ball(0.014).at(0.024, side * 0.018, 0.014);
        bear = bear.with(ear, 0.008).with(paw, 0.012).with(foot, 0.014);
    }
    let label = [
        "U1",
        "honey bear",
        "squeeze bottle in the form of a sitting bear, 150 mm high",
    ];
    CatalogueObject::new(label, 13, 0.150, bear.standing(0.006))
}

/// A flat, broad bottle with a dented grip on one side and its cap on the other.
fn detergent_bottle() -> CatalogueObject {
    let body = Solid::standing_box(0.096, 0.058, 0.150, 0.014)
        .within(
            Solid::below([-0.048, 0.0, 0.115], [-0.030, 0.0, 0.040]),
            0.020,
        )
        .within(
            Solid::below([0.048, 0.0, 0.140], [0.030, 0.0, 0.020]),
            0.015,
        );
    let grip = Solid::ellipsoid(0.020, 0.050, 0.034).at(-0.060, 0.0, 0.080);
    let cap = Solid::frustum((0.025, 0.130), (0.020, 0.185), 0.005).at(0.014, 0.0, 0.0);
    let bottle = body.without(grip, 0.012).with(cap, 0.010);
    let label = [
        "U2",
        "detergent bottle",
        "flat bottle with a dented grip and an off-centre cap, 96 by 60 mm, 185 mm high",
    ];
    CatalogueObject::new(label, 14, 0.185, bottle)
}
