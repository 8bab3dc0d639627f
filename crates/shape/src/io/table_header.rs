//! Finds the columns x, y and z of a table by their names.

/// Words of names that mean a position.
const POSITION: [&str; 13] = [
    "",
    "pos",
    "position",
    "positions",
    "point",
    "points",
    "p",
    "coord",
    "coords",
    "coordinate",
    "coordinates",
    "location",
    "vertex",
];
/// Words of names that mean a direction, a speed or the like.
const NO_POSITION: [&str; 18] = [
    "n",
    "normal",
    "normals",
    "norm",
    "v",
    "vel",
    "velocity",
    "orientation",
    "rotation",
    "quat",
    "quaternion",
    "q",
    "angular",
    "linear",
    "color",
    "gradient",
    "force",
    "acceleration",
];

/// Why no columns were found.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Unnamed {
    /// No three columns have names that differ in x, y and z alone.
    None,
    /// Several groups of three have.
    Several,
}

/// Where the coordinates stand among `names`.
///
/// Names are compared in lower case and without quotes and units: `x`, `X`, `x [m]`, `pos_x`,
/// `px`, `x_coord`, `field.point.x`, `Points:0`. Three columns belong together if their names
/// agree in all but x, y, z (or 0, 1, 2 behind a sign).
pub(super) fn columns(names: &[&str]) -> Result<[usize; 3], Unnamed> {
    let parts: Vec<_> = names.iter().map(|name| split(name)).collect();
    let mut groups: Vec<(&str, [usize; 3])> = Vec::new();
    for (first, part) in parts.iter().enumerate() {
        let Some((base, 0)) = part else { continue };
        let place = |axis: usize| {
            let same = |p: &Option<(String, usize)>| *p == Some((base.clone(), axis));
            parts.iter().position(same)
        };
        if let (Some(y), Some(z)) = (place(1), place(2)) {
            groups.push((base, [first, y, z]));
        }
    }
    let words = |base: &str| -> Vec<String> {
        base.split(|c: char| !c.is_alphanumeric())
            .map(str::to_owned)
            .collect()
    };
    groups.retain(|(base, _)| {
        !words(base)
            .iter()
            .any(|w| NO_POSITION.contains(&w.as_str()))
    });
    groups.dedup_by(|b, a| a.0 == b.0);
    if let Some((_, found)) = groups.iter().find(|(base, _)| base.is_empty()) {
        return Ok(*found);
    }
    let known = |base: &str| {
        words(base)
            .iter()
            .any(|w| !w.is_empty() && POSITION.contains(&w.as_str()))
    };
    let position: Vec<_> = groups.iter().filter(|(base, _)| known(base)).collect();
    match (&position[..], &groups[..]) {
        ([one], _) => Ok(one.1),
        ([], [one]) => Ok(one.1),
        ([], []) => Err(Unnamed::None),
        _ => Err(Unnamed::Several),
    }
}

/// The name without its axis, and the axis.
fn split(name: &str) -> Option<(String, usize)> {
    let name = plain(name);
    let axis_of = |word: &str| ["x", "y", "z"].iter().position(|axis| *axis == word);
    if let Some(axis) = axis_of(&name) {
        return Some((String::new(), axis));
    }
    // `Points:0`, `Points_0`, `points[0]`
    let digits = name.trim_end_matches(']');
    if let Some((base, digit)) = digits
        .char_indices()
        .next_back()
        .map(|(i, _)| digits.split_at(i))
    {
        let axis = ["0", "1", "2"].iter().position(|d| *d == digit);
        let sign = base.ends_with([':', '_', '[', '.', '/', '-']);
        let base = base.trim_end_matches([':', '_', '[', '.', '/', '-']);
        if let (Some(axis), true, true) = (axis, sign, POSITION[1..].contains(&base)) {
            return Some((format!("{base} #"), axis));
        }
    }
    let words: Vec<&str> = name.split(|c: char| !c.is_alphanumeric()).collect();
    let alone: Vec<usize> = (0..words.len())
        .filter(|&i| axis_of(words[i]).is_some())
        .collect();
    if let [at] = alone[..] {
        let axis = axis_of(words[at])?;
        let base: Vec<&str> = [&words[..at], &words[at + 1..]].concat();
        return Some((base.join(" ").trim().to_owned(), axis));
    }
    // `posx`, `px`, `xpos`
    let (first, rest) = name.split_at_checked(1)?;
    if let (Some(axis), true) = (axis_of(first), POSITION[1..].contains(&rest)) {
        return Some((rest.to_owned(), axis));
    }
    let (rest, last) = name.split_at_checked(name.len() - 1)?;
    let axis = axis_of(last)?;
    let known = POSITION[1..].contains(&rest) || NO_POSITION.contains(&rest);
    known.then(|| (rest.to_owned(), axis))
}

/// Lower case, without quotes and unit.
fn plain(name: &str) -> String {
    let bare = name.trim().trim_matches(['"', '\'']).trim().to_lowercase();
    let units = [
        "m",
        "mm",
        "cm",
        "in",
        "meter",
        "meters",
        "metre",
        "metres",
        "millimeters",
    ];
    for (open, close) in [('[', ']'), ('(', ')')] {
        if let Some((head, unit)) = bare.strip_suffix(close).and_then(|b| b.rsplit_once(open))
            && units.contains(&unit.trim())
        {
            return head.trim().to_owned();
        }
    }
    for unit in units {
        let head = bare.strip_suffix(unit).and_then(|b| b.strip_suffix('_'));
        if let Some(head) = head.filter(|h| !h.is_empty()) {
            return head.to_owned();
        }
    }
    bare
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_of_many_programs() {
        let cases: [(&[&str], [usize; 3]); 13] = [
            (&["id", "Z", "Y", "X"], [3, 2, 1]),
            (&["timestamp", "x [m]", "y [m]", "z [m]"], [1, 2, 3]),
            (&["id", "pos_x", "pos_y", "pos_z"], [1, 2, 3]),
            (&["nx", "ny", "nz", "px", "py", "pz"], [3, 4, 5]),
            (
                &["%time", "field.point.x", "field.point.y", "field.point.z"],
                [1, 2, 3],
            ),
            (
                &["\"Result\"", "\"Points:0\"", "\"Points:1\"", "\"Points:2\""],
                [1, 2, 3],
            ),
            (
                &[
                    "Normals:0",
                    "Normals:1",
                    "Normals:2",
                    "Points_0",
                    "Points_1",
                    "Points_2",
                ],
                [3, 4, 5],
            ),
            (
                &["normal_x", "normal_y", "normal_z", "x_m", "y_m", "z_m"],
                [3, 4, 5],
            ),
            (&["x", "y", "z", "vx", "vy", "vz"], [0, 1, 2]),
            (
                &[
                    "pose.position.x",
                    "pose.position.y",
                    "pose.position.z",
                    "pose.orientation.x",
                    "pose.orientation.y",
                    "pose.orientation.z",
                ],
                [0, 1, 2],
            ),
            (
                &["R", "X Coordinate", "Y Coordinate", "Z Coordinate"],
                [1, 2, 3],
            ),
            (&["marker_x", "marker_y", "marker_z"], [0, 1, 2]),
            (&["x(mm)", "y(mm)", "z(mm)"], [0, 1, 2]),
        ];
        for (names, expected) in cases {
            assert_eq!(columns(names), Ok(expected), "{names:?}");
        }
    }

    #[test]
    fn other_names_are_not_guessed() {
        assert_eq!(columns(&["a", "b", "c"]), Err(Unnamed::None));
        assert_eq!(columns(&["nx", "ny", "nz"]), Err(Unnamed::None));
        let two = [
            "left_x", "left_y", "left_z", "right_x", "right_y", "right_z",
        ];
        assert_eq!(columns(&two), Err(Unnamed::Several));
    }
}
