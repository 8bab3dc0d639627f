//! URDFs of hands that exist nowhere, made of boxes and capsules.

use std::fmt::Write;

/// A URDF that is being written.
struct Robot(String);

impl Robot {
    fn new(name: &str) -> Self {
        Robot(format!("<robot name=\"{name}\">"))
    }

    /// A link with one box: its middle and its edges, in the frame of the link.
    fn block(&mut self, link: &str, middle: [f64; 3], edges: [f64; 3]) -> &mut Self {
        let [x, y, z] = middle;
        let [a, b, c] = edges;
        write!(
            self.0,
            "<link name=\"{link}\"><collision><origin xyz=\"{x} {y} {z}\"/><geometry><box size=\"{a} {b} {c}\"/></geometry></collision></link>"
        )
        .unwrap();
        self
    }

    /// A link with a cylinder along z from its origin.
    fn rod(&mut self, link: &str, length: f64, radius: f64) -> &mut Self {
        let z = length / 2.0;
        write!(
            self.0,
            "<link name=\"{link}\"><collision><origin xyz=\"0 0 {z}\"/><geometry><cylinder radius=\"{radius}\" length=\"{length}\"/></geometry></collision></link>"
        )
        .unwrap();
        self
    }

    fn frame(&mut self, link: &str) -> &mut Self {
        write!(self.0, "<link name=\"{link}\"/>").unwrap();
        self
    }

    fn joint(&mut self, joint: &Joint<'_>) -> &mut Self {
        let Joint {
            name,
            kind,
            between: [parent, child],
            xyz: [x, y, z],
            rpy: [r, p, w],
            axis: [a, b, c],
            limits: [lower, upper],
            mimic,
        } = *joint;
        let mimic = mimic.map_or(String::new(), |(master, factor)| {
            format!("<mimic joint=\"{master}\" multiplier=\"{factor}\"/>")
        });
        write!(
            self.0,
            "<joint name=\"{name}\" type=\"{kind}\"><parent link=\"{parent}\"/><child link=\"{child}\"/><origin xyz=\"{x} {y} {z}\" rpy=\"{r} {p} {w}\"/><axis xyz=\"{a} {b} {c}\"/><limit lower=\"{lower}\" upper=\"{upper}\"/>{mimic}</joint>"
        )
        .unwrap();
        self
    }

    fn text(&self) -> String {
        format!("{}</robot>", self.0)
    }
}

#[derive(Clone, Copy)]
struct Joint<'a> {
    name: &'a str,
    kind: &'a str,
    between: [&'a str; 2],
    xyz: [f64; 3],
    rpy: [f64; 3],
    axis: [f64; 3],
    limits: [f64; 2],
    mimic: Option<(&'a str, f64)>,
}

impl Joint<'_> {
    const PLAIN: Joint<'static> = Joint {
        name: "",
        kind: "revolute",
        between: ["", ""],
        xyz: [0.0; 3],
        rpy: [0.0; 3],
        axis: [0.0, 1.0, 0.0],
        limits: [0.0, 0.0],
        mimic: None,
    };
}

/// Two jaws that slide along y and reach along x; 40 mm each.
pub(crate) fn parallel_jaws(zero_is_open: bool, mimic: bool) -> String {
    let mut robot = Robot::new("jaws");
    robot.block("base", [0.03, 0.0, 0.0], [0.06, 0.12, 0.04]);
    let start = if zero_is_open { 0.04 } else { 0.0 };
    let inward = if zero_is_open { -1.0 } else { 1.0 };
    for (name, side) in [("left", 1.0), ("right", -1.0)] {
        robot.block(name, [0.025, 0.005 * side, 0.0], [0.07, 0.01, 0.02]);
        let slide = format!("slide_{name}");
        robot.joint(&Joint {
            name: &slide,
            kind: "prismatic",
            between: ["base", name],
            xyz: [0.075, side * start, 0.0],
            axis: [0.0, side * inward, 0.0],
            limits: [0.0, 0.04],
            mimic: (mimic && name == "right").then_some(("slide_left", 1.0)),
            ..Joint::PLAIN
        });
    }
    robot.text()
}

/// A gripper that one motor moves: each side has a knuckle, a finger that stays upright, its pad, and a
/// bar beside the knuckle.
pub(crate) fn linkage() -> String {
    let mut robot = Robot::new("linkage");
    robot.block("palm", [0.0, 0.0, 0.02], [0.06, 0.08, 0.04]);
    for (name, side) in [("left", 1.0), ("right", -1.0)] {
        let link = |part: &str| format!("{name}_{part}");
        let (knuckle, finger) = (link("knuckle"), link("finger"));
        let (pad, bar) = (link("pad"), link("bar"));
        robot.rod(&knuckle, 0.05, 0.005);
        robot.block(&finger, [0.0, side * 0.005, 0.025], [0.02, 0.008, 0.05]);
        robot.block(&pad, [0.0, 0.0, 0.0], [0.02, 0.006, 0.03]);
        robot.rod(&bar, 0.045, 0.004);
        let first = name == "left";
        let follows = |factor: f64| Some(("motor", factor));
        // Turning about x by a positive angle moves the top towards -y.
        let hinge = Joint {
            axis: [side, 0.0, 0.0],
            limits: [0.0, 0.8],
            ..Joint::PLAIN
        };
        let name = if first {
            "motor".to_owned()
        } else {
            link("joint")
        };
        robot.joint(&Joint {
            name: &name,
            between: ["palm", &knuckle],
            xyz: [0.0, side * 0.035, 0.048],
            rpy: [-side * 0.3, 0.0, 0.0],
            mimic: if first { None } else { follows(1.0) },
            ..hinge
        });
        robot.joint(&Joint {
            name: &link("upright"),
            between: [&knuckle, &finger],
            xyz: [0.0, 0.0, 0.055],
            rpy: [side * 0.3, 0.0, 0.0],
            mimic: follows(-1.0),
            limits: [-0.8, 0.0],
            ..hinge
        });
        robot.joint(&Joint {
            name: &link("glue"),
            kind: "fixed",
            between: [&finger, &pad],
            xyz: [0.0, -side * 0.004, 0.035],
            ..Joint::PLAIN
        });
        robot.joint(&Joint {
            name: &link("bar_joint"),
            between: ["palm", &bar],
            xyz: [0.0, side * 0.012, 0.05],
            rpy: [-side * 0.3, 0.0, 0.0],
            mimic: follows(1.0),
            ..hinge
        });
    }
    robot.text()
}

/// A finger of two rods that stands on `base` and bends about y by angles of this sign.
fn finger(robot: &mut Robot, name: &str, base: &Joint<'_>, sign: f64) {
    let (near, far) = (format!("{name}_1"), format!("{name}_2"));
    robot.rod(&near, 0.07, 0.009).rod(&far, 0.06, 0.009);
    let limits = [-1.2, 1.4].map(|l| l * sign);
    let limits = [limits[0].min(limits[1]), limits[0].max(limits[1])];
    let bend = Joint {
        axis: [0.0, sign, 0.0],
        limits,
        ..*base
    };
    let (joint, next) = (format!("{name}_joint_1"), format!("{name}_joint_2"));
    robot.joint(&Joint {
        name: &joint,
        between: [base.between[0], &near],
        ..bend
    });
    robot.joint(&Joint {
        name: &next,
        between: [&near, &far],
        xyz: [0.0, 0.0, 0.075],
        rpy: [0.0; 3],
        ..bend
    });
}

/// Three fingers about z, two of them on knuckles that turn together; closing is positive for `sign` 1.
pub(crate) fn spread_hand(sign: f64) -> String {
    let mut robot = Robot::new("spread");
    robot.block("palm", [0.0, 0.0, 0.03], [0.12, 0.12, 0.06]);
    let pi = std::f64::consts::PI;
    for (name, side) in [("one", 1.0), ("two", -1.0)] {
        let (knuckle, turn) = (format!("{name}_0"), format!("{name}_knuckle"));
        robot.block(&knuckle, [0.0, 0.0, 0.01], [0.03, 0.03, 0.02]);
        robot.joint(&Joint {
            name: &turn,
            between: ["palm", &knuckle],
            xyz: [0.035, side * 0.035, 0.062],
            rpy: [0.0, 0.0, pi],
            axis: [0.0, 0.0, side],
            limits: [0.0, 1.5],
            mimic: (name == "two").then_some(("one_knuckle", 1.0)),
            ..Joint::PLAIN
        });
        let base = Joint {
            between: [&knuckle, ""],
            xyz: [0.0, 0.0, 0.025],
            ..Joint::PLAIN
        };
        finger(&mut robot, name, &base, sign);
    }
    let base = Joint {
        between: ["palm", ""],
        xyz: [-0.04, 0.0, 0.075],
        ..Joint::PLAIN
    };
    finger(&mut robot, "thumb", &base, sign);
    robot.text()
}

/// Four fingers that stand along z and bend towards x, and a thumb on a joint that turns it before them.
pub(crate) fn five_fingers() -> String {
    let mut robot = Robot::new("five");
    robot.block("wrist", [-0.01, 0.0, -0.05], [0.03, 0.09, 0.1]);
    let bend = |limits| Joint {
        limits,
        ..Joint::PLAIN
    };
    for (k, name) in ["index", "middle", "ring", "little"].iter().enumerate() {
        let links = ["0", "1", "2", "3"].map(|part| format!("{name}_{part}"));
        robot.frame(&links[0]);
        let joints = ["0", "1", "2", "3"].map(|part| format!("{name}_j{part}"));
        robot.joint(&Joint {
            name: &joints[0],
            between: ["wrist", &links[0]],
            xyz: [0.0, 0.033 - 0.022 * k as f64, 0.008],
            axis: [1.0, 0.0, 0.0],
            limits: [-0.35, 0.35],
            ..Joint::PLAIN
        });
        for (part, length) in [(1, 0.045), (2, 0.03), (3, 0.025)] {
            robot.rod(&links[part], length - 0.004, 0.0085);
            robot.joint(&Joint {
                name: &joints[part],
                between: [&links[part - 1], &links[part]],
                xyz: [0.0, 0.0, if part == 1 { 0.0 } else { length + 0.01 }],
                ..bend([-0.2, 1.57])
            });
        }
    }
    robot.frame("thumb_0").frame("thumb_1");
    robot.joint(&Joint {
        name: "thumb_j0",
        between: ["wrist", "thumb_0"],
        xyz: [0.012, 0.03, -0.07],
        axis: [0.0, 0.0, 1.0],
        limits: [-1.05, 1.05],
        ..Joint::PLAIN
    });
    robot.joint(&Joint {
        name: "thumb_j1",
        between: ["thumb_0", "thumb_1"],
        rpy: [-0.6, 0.6, 0.0],
        limits: [0.0, 1.2],
        axis: [1.0, 0.0, 0.0],
        ..Joint::PLAIN
    });
    robot.rod("thumb_2", 0.05, 0.01).rod("thumb_3", 0.035, 0.01);
    robot.joint(&Joint {
        name: "thumb_j2",
        between: ["thumb_1", "thumb_2"],
        axis: [0.0, -1.0, 0.0],
        ..bend([-0.3, 1.0])
    });
    robot.joint(&Joint {
        name: "thumb_j3",
        between: ["thumb_2", "thumb_3"],
        xyz: [0.0, 0.0, 0.055],
        axis: [0.0, -1.0, 0.0],
        ..bend([-0.2, 1.5])
    });
    robot.text()
}

/// A hand on an arm of three joints; its base is glued to the last link, `flange`.
pub(crate) fn arm(hand: &str) -> String {
    let mut robot = Robot::new("arm");
    robot.block("stand", [0.0, 0.0, 0.1], [0.1, 0.1, 0.2]);
    for (parent, child) in [("stand", "upper"), ("upper", "lower"), ("lower", "flange")] {
        robot.rod(child, 0.2, 0.04);
        robot.joint(&Joint {
            name: &format!("{child}_joint"),
            between: [parent, child],
            xyz: [0.0, 0.0, 0.25],
            limits: [-2.0, 2.0],
            ..Joint::PLAIN
        });
    }
    robot.joint(&Joint {
        name: "mount",
        kind: "fixed",
        between: ["flange", "base"],
        xyz: [0.0, 0.0, 0.21],
        rpy: [0.0, -std::f64::consts::FRAC_PI_2, 0.0],
        ..Joint::PLAIN
    });
    let inside = hand.split_once('>').map_or("", |(_, rest)| rest);
    format!("{}{inside}", robot.0)
}
