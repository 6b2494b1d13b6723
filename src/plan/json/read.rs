//! From `plan.json` to a plan, strictly.

use std::collections::BTreeMap;

use super::{FORMAT, VERSION};
use crate::json::{ReadError, Value};
use crate::plan::{Apart, Label, Link, Mission, Objective, Plan, RobotPlan, Separator, Tube};

type Result<T> = std::result::Result<T, ReadError>;

/// Reads a plan.
///
/// # Errors
/// The first place where the text is no JSON, no plan of this format and version, or has a list of
/// the wrong length.
pub fn read(text: &str) -> Result<Plan> {
    Value::parse(text).and_then(|value| plan(&value)).map_err(ReadError::from_root)
}

fn plan(value: &Value) -> Result<Plan> {
    let format = field(value, "format", string)?;
    if format != FORMAT {
        return Err(ReadError::new(format!("expected \"{FORMAT}\", not {format:?}")).in_key("format"));
    }
    let version = field(value, "version", natural)?;
    if version as u64 != VERSION {
        return Err(
            ReadError::new(format!("version {version} is not known, only {VERSION}")).in_key("version")
        );
    }
    let length = field(value, "length", natural)?;
    let tubes: Vec<Tube> = field(value, "tubes", |v| list(v, tube))?;
    let sizes: BTreeMap<String, (usize, usize)> =
        tubes.iter().map(|t| (t.dynamics.clone(), (t.center.len(), t.m[0].len()))).collect();
    Ok(Plan {
        tool: field(value, "tool", string)?,
        mission: field(value, "mission", mission)?,
        step_s: field(value, "step_s", number)?,
        length,
        loop_start: field(value, "loop_start", natural)?,
        tubes,
        robots: field(value, "robots", |v| list(v, |v| robot(v, length, &sizes)))?,
        links: field(value, "links", |v| optional(v, |v| steps(v, length, |v| list(v, link))))?,
        separation: field(value, "separation", |v| separation(v, length))?,
        objective: field(value, "objective", |v| optional(v, objective))?,
    })
}

fn mission(value: &Value) -> Result<Mission> {
    Ok(Mission {
        name: field(value, "name", string)?,
        sha256: field(value, "sha256", string)?,
        set: field(value, "set", |v| map(v, string))?,
    })
}

fn tube(value: &Value) -> Result<Tube> {
    let center = field(value, "disturbance", |v| field(v, "center", numbers))?;
    let n = center.len();
    let half_width = field(value, "disturbance", |v| field(v, "half_width", |v| sized(v, n, number)))?;
    let d = field(value, "D", |v| list(v, |v| sized(v, n, |v| sized(v, n, number))))?;
    if d.is_empty() {
        return Err(ReadError::new("expected at least one matrix").in_key("D"));
    }
    let m = field(value, "M", |v| gains(v, d.len(), n))?;
    Ok(Tube {
        dynamics: field(value, "dynamics", string)?,
        reserve: field(value, "reserve", |v| sized(v, n, number))?,
        center,
        half_width,
        d,
        m,
    })
}

/// K matrices of one height and n columns.
fn gains(value: &Value, k: usize, n: usize) -> Result<Vec<Vec<Vec<f64>>>> {
    if matches!(value, Value::Object(_)) {
        return Err(ReadError::new("gains for each mode are not supported by this version"));
    }
    let m: Vec<Vec<Vec<f64>>> = sized(value, k, |v| list(v, |v| sized(v, n, number)))?;
    match m.iter().position(|matrix| matrix.len() != m[0].len()) {
        Some(i) => Err(wrong_length(m[0].len(), m[i].len()).in_item(i)),
        None => Ok(m),
    }
}

fn robot(value: &Value, length: usize, sizes: &BTreeMap<String, (usize, usize)>) -> Result<RobotPlan> {
    if get(value, "mode")?.is_some() {
        let message = "modes of switching models are not supported by this version";
        return Err(ReadError::new(message).in_key("mode"));
    }
    let dynamics = field(value, "dynamics", string)?;
    let Some(&(n, m)) = sizes.get(&dynamics) else {
        return Err(ReadError::new(format!("there is no tube for {dynamics:?}")).in_key("dynamics"));
    };
    let pieces = |v: &Value| list(v, separator);
    Ok(RobotPlan {
        name: field(value, "name", string)?,
        z: field(value, "z", |v| steps(v, length, |v| sized(v, n, number)))?,
        v: field(value, "v", |v| steps(v, length, |v| sized(v, m, number)))?,
        regions: field(value, "regions", |v| map(v, |v| steps(v, length, label)))?,
        outside: field(value, "outside", |v| map(v, |v| steps(v, length, |v| optional(v, pieces))))?,
        clear: field(value, "clear", |v| map(v, |v| steps(v, length, pieces)))?,
        dynamics,
    })
}

fn label(value: &Value) -> Result<Label> {
    match string(value)?.as_str() {
        "in" => Ok(Label::In),
        "out" => Ok(Label::Out),
        "unknown" => Ok(Label::Unknown),
        other => Err(ReadError::new(format!("expected \"in\", \"out\" or \"unknown\", not {other:?}"))),
    }
}

fn separator(value: &Value) -> Result<Separator> {
    Ok(Separator {
        piece: field(value, "piece", natural)?,
        normal: field(value, "normal", numbers)?,
        offset: field(value, "offset", number)?,
    })
}

fn link(value: &Value) -> Result<Link> {
    let named = |v: &Value| Ok((field(v, "blocker", string)?, separator(v)?));
    Ok(Link {
        from: field(value, "from", string)?,
        to: field(value, "to", string)?,
        hops: field(value, "hops", natural)?,
        separators: field(value, "separators", |v| list(v, named))?,
    })
}

fn separation(value: &Value, length: usize) -> Result<Vec<Vec<Apart>>> {
    match value {
        Value::List(items) if items.is_empty() => Ok(Vec::new()),
        _ => steps(value, length, |v| list(v, apart)),
    }
}

fn apart(value: &Value) -> Result<Apart> {
    let pair = field(value, "pair", |v| sized(v, 2, string))?;
    let [first, second] = <[String; 2]>::try_from(pair).map_err(|p| wrong_length(2, p.len()))?;
    Ok(Apart {
        pair: (first, second),
        axis: field(value, "axis", natural)?,
        sign: field(value, "sign", |v| match number(v)? {
            1.0 => Ok(1),
            -1.0 => Ok(-1),
            other => Err(ReadError::new(format!("expected 1 or -1, not {other}"))),
        })?,
    })
}

fn objective(value: &Value) -> Result<Objective> {
    Ok(Objective {
        kind: field(value, "kind", string)?,
        value: field(value, "value", number)?,
        bound: field(value, "bound", number)?,
        proved: field(value, "proved", truth)?,
    })
}

// What every format is made of.

fn get<'a>(value: &'a Value, key: &str) -> Result<Option<&'a Value>> {
    match value {
        Value::Object(fields) => Ok(fields.iter().find(|(k, _)| k == key).map(|(_, v)| v)),
        _ => Err(expected("an object", value)),
    }
}

fn field<T>(value: &Value, key: &str, read: impl FnOnce(&Value) -> Result<T>) -> Result<T> {
    match get(value, key)? {
        Some(inner) => read(inner).map_err(|e| e.in_key(key)),
        None => Err(ReadError::new(format!("the key {key:?} is missing"))),
    }
}

fn optional<T>(value: &Value, read: impl FnOnce(&Value) -> Result<T>) -> Result<Option<T>> {
    if *value == Value::Null { Ok(None) } else { read(value).map(Some) }
}

fn list<T>(value: &Value, read: impl Fn(&Value) -> Result<T>) -> Result<Vec<T>> {
    let Value::List(items) = value else {
        return Err(expected("an array", value));
    };
    items.iter().enumerate().map(|(i, item)| read(item).map_err(|e| e.in_item(i))).collect()
}

fn sized<T>(value: &Value, size: usize, read: impl Fn(&Value) -> Result<T>) -> Result<Vec<T>> {
    match value {
        Value::List(items) if items.len() != size => Err(wrong_length(size, items.len())),
        _ => list(value, read),
    }
}

/// One entry a step, 0 to L.
fn steps<T>(value: &Value, length: usize, read: impl Fn(&Value) -> Result<T>) -> Result<Vec<T>> {
    sized(value, length.saturating_add(1), read)
}

fn map<T>(value: &Value, read: impl Fn(&Value) -> Result<T>) -> Result<BTreeMap<String, T>> {
    let Value::Object(fields) = value else {
        return Err(expected("an object", value));
    };
    fields.iter().map(|(k, v)| Ok((k.clone(), read(v).map_err(|e| e.in_key(k))?))).collect()
}

fn string(value: &Value) -> Result<String> {
    match value {
        Value::Text(text) => Ok(text.clone()),
        _ => Err(expected("a string", value)),
    }
}

fn number(value: &Value) -> Result<f64> {
    match value {
        Value::Natural(n) => Ok(*n as f64),
        Value::Number(x) => Ok(*x),
        _ => Err(expected("a number", value)),
    }
}

fn numbers(value: &Value) -> Result<Vec<f64>> {
    list(value, number)
}

fn natural(value: &Value) -> Result<usize> {
    match value {
        Value::Natural(n) => usize::try_from(*n).map_err(|_| expected("a smaller number", value)),
        _ => Err(expected("a whole number, not negative, without fraction or exponent", value)),
    }
}

fn truth(value: &Value) -> Result<bool> {
    match value {
        Value::Bool(truth) => Ok(*truth),
        _ => Err(expected("true or false", value)),
    }
}

fn expected(what: &str, found: &Value) -> ReadError {
    ReadError::new(format!("expected {what}, found {}", found.kind()))
}

fn wrong_length(expected: usize, found: usize) -> ReadError {
    ReadError::new(format!("expected {expected} entries, found {found}"))
}
