//! The twelve objects S1 to S12 of the library.
//!
//! Their sizes are those of common objects in kitchens and bathrooms. The proportions of the
//! bottles S5 and S7, the can S2, the egg S8 and the orange S11 are such that S7 and S8 lie near
//! the straight line from S5 to others in the space of radial functions, as in Fig. 4 of the paper.

use crate::object::CatalogueObject;
use crate::solid::Solid;

/// S1 to S12 in this order.
pub(crate) fn build() -> Vec<CatalogueObject> {
    vec![
        milk_carton(),
        soup_can(),
        bell_flask(),
        pear(),
        shampoo_bottle(),
        rubber_duck(),
        lotion_bottle(),
        chocolate_egg(),
        waisted_bottle(),
        tea_box(),
        orange(),
        softball(),
    ]
}

/// A square body with a gable roof and a tapered seam along the ridge.
fn milk_carton() -> CatalogueObject {
    let body = Solid::standing_box(0.070, 0.070, 0.138, 0.004)
        .within(
            Solid::below([0.0, 0.035, 0.100], [0.0, 0.033, 0.027]),
            0.004,
        )
        .within(
            Solid::below([0.0, -0.035, 0.100], [0.0, -0.033, 0.027]),
            0.004,
        );
    let seam = Solid::standing_box(0.064, 0.030, 0.040, 0.003)
        .at(0.0, 0.0, 0.110)
        .within(Solid::below([0.0, 0.006, 0.150], [0.0, 0.02, 0.005]), 0.003)
        .within(
            Solid::below([0.0, -0.006, 0.150], [0.0, -0.02, 0.005]),
            0.003,
        );
    let label = [
        "S1",
        "milk carton",
        "half-litre gable-top carton, 70 mm square, 150 mm high",
    ];
    CatalogueObject::new(label, 1, 0.150, body.with(seam, 0.006))
}

fn soup_can() -> CatalogueObject {
    let can = Solid::frustum((0.034, 0.0), (0.034, 0.101), 0.003);
    let label = ["S2", "soup can", "plain tin can, 68 mm wide, 101 mm high"];
    CatalogueObject::new(label, 2, 0.101, can)
}

/// A broad foot with a concave transition to a slender neck.
fn bell_flask() -> CatalogueObject {
    let foot = Solid::frustum((0.046, 0.0), (0.044, 0.030), 0.010);
    let sweep = Solid::frustum((0.045, 0.010), (0.008, 0.114), 0.004);
    let neck = Solid::frustum((0.020, 0.055), (0.0165, 0.150), 0.005);
    let flask = foot.with(sweep, 0.010).with(neck, 0.012);
    let label = [
        "S3",
        "bell-shaped flask",
        "oil flask flaring from a slim neck to a 94 mm foot, 150 mm high",
    ];
    CatalogueObject::new(label, 3, 0.150, flask)
}

fn pear() -> CatalogueObject {
    let belly = Solid::ellipsoid(0.036, 0.035, 0.035).at(0.0, 0.0, 0.031);
    let top = Solid::ball(0.0175).at(0.002, 0.0, 0.0785);
    let fruit = belly.with(top, 0.022).standing(0.004);
    let label = [
        "S4",
        "pear",
        "pear standing upright, 72 mm wide, 96 mm high",
    ];
    CatalogueObject::new(label, 4, 0.096, fruit)
}

/// An oval body with rounded shoulders and a round cap; S5 and S7 have this form.
fn oval_bottle(body: (f64, f64), flatness: f64, cap: (f64, f64)) -> Solid {
    let ((radius, shoulder), (cap_radius, top)) = (body, cap);
    let oval = Solid::frustum((0.97 * radius, 0.0), (radius, shoulder), 0.010)
        .stretched(1.0, flatness, 1.0);
    let slope = Solid::frustum(
        (radius - 0.001, shoulder - 0.014),
        (0.6 * cap_radius, shoulder + 0.018),
        0.003,
    )
    .stretched(1.0, flatness, 1.0);
    let lid = Solid::frustum(
        (1.12 * cap_radius, shoulder - 0.010),
        (cap_radius, top),
        0.004,
    );
    oval.with(slope, 0.003).with(lid, 0.006)
}

fn shampoo_bottle() -> CatalogueObject {
    let bottle = oval_bottle((0.037, 0.150), 0.75, (0.018, 0.195));
    let label = [
        "S5",
        "shampoo bottle",
        "oval bottle with shoulders and cap, 74 by 55 mm, 195 mm high",
    ];
    CatalogueObject::new(label, 5, 0.195, bottle)
}

fn rubber_duck() -> CatalogueObject {
    let body = Solid::ellipsoid(0.046, 0.037, 0.032).at(0.0, 0.0, 0.027);
    let head = Solid::ball(0.0245).at(0.016, 0.0, 0.066);
    let beak = Solid::ellipsoid(0.014, 0.010, 0.006)
        .turned(0.0, -0.45, 0.0)
        .at(0.036, 0.0, 0.063);
    let tail = Solid::ellipsoid(0.019, 0.013, 0.010)
        .turned(0.0, 0.45, 0.0)
        .at(-0.038, 0.0, 0.040);
    let duck = body
        .with(head, 0.020)
        .with(beak, 0.005)
        .with(tail, 0.012)
        .standing(0.004);
    let label = [
        "S6",
        "rubber duck",
        "bath toy with head, beak and tail, 105 mm long, 91 mm high",
    ];
    CatalogueObject::new(label, 6, 0.0905, duck)
}

fn lotion_bottle() -> CatalogueObject {
    let bottle = oval_bottle((0.036, 0.108), 0.87, (0.020, 0.145));
    let label = [
        "S7",
        "lotion bottle",
        "small oval bottle with a wide cap, 72 by 62 mm, 145 mm high",
    ];
    CatalogueObject::new(label, 7, 0.145, bottle)
}

/// A blunt and a pointed ellipsoid with a smooth blend; two half-ellipsoids of different height
/// would have a discontinuous curvature where they meet.
fn chocolate_egg() -> CatalogueObject {
    let blunt = Solid::ellipsoid(0.037, 0.037, 0.044).at(0.0, 0.0, 0.040);
    let pointed = Solid::ellipsoid(0.026, 0.026, 0.036).at(0.0, 0.0, 0.079);
    let egg = blunt.with(pointed, 0.030).standing(0.004);
    let label = [
        "S8",
        "chocolate egg",
        "large egg standing on its blunt end, 76 mm wide, 115 mm high",
    ];
    CatalogueObject::new(label, 8, 0.1152, egg)
}

/// Two stacked bulbs under a screw cap.
fn waisted_bottle() -> CatalogueObject {
    let lower = Solid::ellipsoid(0.037, 0.037, 0.038).at(0.0, 0.0, 0.034);
    let upper = Solid::ellipsoid(0.032, 0.032, 0.033).at(0.0, 0.0, 0.090);
    let cap = Solid::frustum((0.020, 0.100), (0.0165, 0.140), 0.004);
    let bottle = lower.with(upper, 0.010).with(cap, 0.006).standing(0.004);
    let label = [
        "S9",
        "double-bulb juice bottle",
        "two bulbs with a waist between them and a cap, 74 mm wide, 140 mm high",
    ];
    CatalogueObject::new(label, 9, 0.140, bottle)
}

fn tea_box() -> CatalogueObject {
    let carton = Solid::standing_box(0.090, 0.060, 0.125, 0.004);
    let label = ["S10", "tea box", "card box, 90 by 60 mm, 125 mm high"];
    CatalogueObject::new(label, 10, 0.125, carton)
}

/// A slightly flattened ball with a dent at the stem.
fn orange() -> CatalogueObject {
    let flesh = Solid::ellipsoid(0.0405, 0.040, 0.039).at(0.0, 0.0, 0.039);
    let stem = Solid::ball(0.010).at(0.0, 0.0, 0.0865);
    let fruit = flesh.without(stem, 0.005);
    let label = [
        "S11",
        "orange",
        "nearly round fruit with a dent at the stem, 81 mm wide",
    ];
    CatalogueObject::new(label, 11, 0.0768, fruit)
}

fn softball() -> CatalogueObject {
    let ball = Solid::SeamedBall {
        radius: 0.0485,
        depth: 0.0012,
        width: 0.16,
    };
    let label = ["S12", "softball", "ball with a sewn seam, 97 mm wide"];
    CatalogueObject::new(label, 12, 0.097, ball.at(0.0, 0.0, 0.0485))
}
