//! A spec as the text of a TOML file.

use std::fmt::Write;

use super::{FingerSpec, HandSpec, PreshapeSpec};

impl HandSpec {
    /// The text of a TOML file from which [`HandSpec::from_toml`] reads the same spec.
    ///
    /// ```
    /// let spec = hand::HandSpec::from_toml(hand::SDH_SPEC)?;
    /// assert_eq!(hand::HandSpec::from_toml(&spec.to_toml())?, spec);
    /// # Ok::<(), hand::SpecTextError>(())
    /// ```
    pub fn to_toml(&self) -> String {
        let mut text = String::new();
        let mut line = |key: &str, value: String| {
            // Writing to a string cannot fail.
            let _ = writeln!(text, "{key} = {value}");
        };
        line("name", quoted(&self.name));
        line("palm", quoted(&self.palm));
        line("approach_axis", numbers(&self.approach_axis));
        line("approach_point", numbers(&self.approach_point));
        line("standoff_m", numbers(&self.standoff_m));
        if let Some(compliant) = self.compliant {
            line("compliant", compliant.to_string());
        }
        if let Some(radius) = self.pad_radius_m {
            line("pad_radius_m", number(radius));
        }
        if let Some(least) = self.least_fingers {
            line("least_fingers", least.to_string());
        }
        let apart = &self.self_distance;
        let _ = write!(
            text,
            "\n[self_distance]\nexempt_within_joints = {}\n{}",
            apart.exempt_within_joints,
            exempt_pairs_text(&apart.exempt_pairs)
        );
        for finger in &self.finger {
            text.push_str(&finger_text(finger));
        }
        for preshape in &self.preshape {
            text.push_str(&preshape_text(preshape));
        }
        text
    }
}

/// The line of `exempt_pairs` in the TOML of a hand.
///
/// ```
/// let pairs = [["palm".to_owned(), "tip".to_owned()]];
/// assert_eq!(
///     hand::exempt_pairs_text(&pairs),
///     "exempt_pairs = [\n    [\"palm\", \"tip\"],\n]\n",
/// );
/// ```
pub fn exempt_pairs_text(pairs: &[[String; 2]]) -> String {
    if pairs.is_empty() {
        return "exempt_pairs = []\n".to_owned();
    }
    let mut text = "exempt_pairs = [\n".to_owned();
    for [a, b] in pairs {
        let _ = writeln!(text, "    [{}, {}],", quoted(a), quoted(b));
    }
    text.push_str("]\n");
    text
}

fn finger_text(finger: &FingerSpec) -> String {
    let tips: Vec<String> = finger.tips.iter().map(|t| quoted(t)).collect();
    format!(
        "\n[[finger]]\nname = {}\ntips = [{}]\nclosing = {}\n",
        quoted(&finger.name),
        tips.join(", "),
        table(&finger.closing)
    )
}

fn preshape_text(preshape: &PreshapeSpec) -> String {
    format!(
        "\n[[preshape]]\nname = {}\njoints = {}\n",
        quoted(&preshape.name),
        table(&preshape.joints)
    )
}

fn table(values: &std::collections::BTreeMap<String, f64>) -> String {
    let entry = |(name, value): (&String, &f64)| format!("{} = {}", quoted(name), number(*value));
    let entries: Vec<String> = values.iter().map(entry).collect();
    format!("{{ {} }}", entries.join(", "))
}

fn numbers(values: &[f64]) -> String {
    let values: Vec<String> = values.iter().map(|v| number(*v)).collect();
    format!("[{}]", values.join(", "))
}

/// A float of TOML: with a point, in the fewest digits that tell it.
fn number(value: f64) -> String {
    if value.is_finite() {
        format!("{:?}", value + 0.0)
    } else {
        toml::Value::Float(value).to_string()
    }
}

fn quoted(text: &str) -> String {
    toml::Value::String(text.to_owned()).to_string()
}
