//! From what a person asks for to how a picture is drawn and from where it is seen.

use souple_io::picture::{
    Backdrop, COLOUR_MAPS, COLOUR_SCALES, ColourMap, ColourScale, Cut, EdgeStyle, LegendPlace, Marks, Theme,
    View,
};
use souple_math::Vec3;
use souple_run::show::{Arrows, Figure, Floor, FrameAxes, Stage, Worn, map_of, unit_of};
use souple_scene::spec::picture::PictureSpec;

use super::{Arguments, Kind};
use crate::command::Refusal;

/// What colours show where nothing else is asked for.
pub const STRESS: &str = "von_mises";

/// How pictures are drawn.
pub fn figure(arguments: &Arguments, kind: Kind) -> Result<Figure, Refusal> {
    let colour = arguments.colour.as_deref().unwrap_or(STRESS);
    let colours = match &arguments.map {
        Some(name) => {
            COLOUR_MAPS
                .find(name)
                .map_err(|error| Refusal::request("map", name.clone(), "", error.to_string()))?
                .build
        }
        None => map_of(colour).unwrap_or_default(),
    };
    let scale = match &arguments.colour_scale {
        Some(name) => {
            COLOUR_SCALES
                .find(name)
                .map_err(|error| Refusal::request("colour_scale", name.clone(), "", error.to_string()))?
                .build
        }
        None => ColourScale::default(),
    };
    let range = arguments.range.as_ref().map(|ends| range_of(ends, colour)).transpose()?;
    if scale == ColourScale::Logarithmic {
        check_log(colours, range)?;
    }
    let edges = match arguments.edges.as_deref().unwrap_or("drawn") {
        "drawn" => EdgeStyle::Drawn,
        "hidden" => EdgeStyle::Hidden,
        "wireframe" => EdgeStyle::Wireframe,
        other => {
            return Err(Refusal::request(
                "edges",
                other,
                "drawn, hidden or wireframe",
                format!("edges cannot be `{other}`"),
            ));
        }
    };
    let frame_axes = match arguments.frame_axes.as_deref().unwrap_or("drawn") {
        "drawn" => FrameAxes::Drawn,
        "numbered" => FrameAxes::Numbered,
        "hidden" => FrameAxes::Hidden,
        other => {
            let message = format!("axes of frames cannot be `{other}`");
            return Err(Refusal::request("frame-axes", other, "drawn, numbered or hidden", message));
        }
    };
    if let Some([low, high]) = range
        && low >= high
    {
        let message = format!("the range {low} to {high} is empty");
        return Err(Refusal::request(
            "range",
            format!("{low},{high}"),
            "two numbers, the lower one first",
            message,
        ));
    }
    if !(0.0..=100.0).contains(&arguments.explode) {
        let message = format!("cells cannot be moved apart by {}", arguments.explode);
        return Err(Refusal::request("explode", arguments.explode.to_string(), "0 to 100", message));
    }
    if !(0.0..1.0).contains(&arguments.shrink) {
        let message = format!("cells cannot shrink by {} of their size", arguments.shrink);
        return Err(Refusal::request("shrink", arguments.shrink.to_string(), "0 to less than 1", message));
    }
    let is_one = kind == Kind::Picture && arguments.moments().is_none();
    let samples = arguments.samples.unwrap_or(if is_one { 3 } else { 2 });
    let cut = arguments.cut.map(|[x, y, z, d]| {
        let normal = Vec3::new(x, y, z);
        Cut { point: normal * (d / normal.length_sq().max(f64::MIN_POSITIVE)), normal }
    });
    if cut.is_some_and(|cut| cut.normal.length_sq() == 0.0) {
        let message = "the normal of the cut is zero".to_owned();
        return Err(Refusal::request("cut", "0,0,0", "a normal that is not zero, and d", message));
    }
    Ok(Figure {
        size: arguments.size.unwrap_or([1280, 800]),
        samples_per_pixel: samples as usize,
        theme: if arguments.dark { Theme::Dark } else { Theme::Light },
        backdrop: if arguments.white { Backdrop::White } else { Backdrop::default() },
        title: arguments.title.clone(),
        clock: !arguments.no_time,
        legend: (!arguments.no_legend).then(LegendPlace::default),
        marks: Marks { triad: arguments.axes, scale_bar: arguments.scale_bar },
        view: None,
        colour_by: Some(colour.to_owned()).filter(|colour| colour != "none"),
        colours,
        scale,
        range: range.map(|[low, high]| (low, high)),
        cut,
        explode: arguments.explode,
        shrink: arguments.shrink,
        arrows: arguments
            .arrows
            .as_ref()
            .map(|field| Arrows { field: field.clone(), scale: arguments.arrow_scale }),
        edges,
        frame_axes,
        worn: worn(arguments),
        letters: 1.0,
        floor: if arguments.floor { Floor::Below } else { Floor::None },
    })
}

/// Arrows on a skin are those of the body that wears it, which is seen where what is asked for is of its inside.
fn worn(arguments: &Arguments) -> Worn {
    if arguments.looks_inside() { Worn::Whole } else { Worn::Arrows }
}

/// The ends of a range: numbers in the unit of a quantity, or quantities of its kind.
fn range_of(ends: &[String; 2], quantity: &str) -> Result<[f64; 2], Refusal> {
    let unit = unit_of(quantity);
    let end = |text: &String| {
        let number = text.parse().or_else(|_| souple_formal::quantity_in(text, unit));
        number.ok().filter(|number: &f64| number.is_finite()).ok_or_else(|| {
            let message = format!("`{text}` is no value of {quantity}");
            let expected = match unit {
                "" => "2 numbers with commas".to_owned(),
                unit => format!("2 numbers with commas, in {unit}, or each with a unit of its kind"),
            };
            Refusal::request("range", text.clone(), expected, message)
        })
    };
    let [low, high] = ends;
    Ok([end(low)?, end(high)?])
}

/// Refuses what a scale of powers of ten cannot have: colours about zero or with a meaning of their own, ends that are not above
/// zero.
fn check_log(colours: ColourMap, range: Option<[f64; 2]>) -> Result<(), Refusal> {
    if colours == ColourMap::Diverging || colours.own_range().is_some() {
        let message =
            "a scale of powers of ten has no zero and no kinds, which the colours of this map stand for";
        return Err(Refusal::request(
            "colour_scale",
            "log",
            "the map sequential or grey",
            message.to_owned(),
        ));
    }
    match range {
        Some([low, _]) if low <= 0.0 => {
            let message = format!("a scale of powers of ten cannot begin at {low}");
            Err(Refusal::request("range", low.to_string(), "two numbers above 0", message))
        }
        _ => Ok(()),
    }
}

/// From where they are seen.
pub fn view(arguments: &Arguments, stage: &Stage) -> Result<View, Refusal> {
    let unit = |name: &str, vector: Vec3| {
        vector.try_normalised().ok_or_else(|| {
            let message = format!("the {name} of the view is zero");
            Refusal::request(name, "0,0,0", "a vector that is not zero", message)
        })
    };
    let [direction, eye, look_at, up] =
        [arguments.direction, arguments.position, arguments.look_at, arguments.up]
            .map(|given| given.map(Vec3::from_array));
    let direction = eye.zip(look_at).map_or(direction, |(eye, look_at)| Some(look_at - eye));
    let asked = PictureSpec {
        direction: direction.map(|direction| unit("direction", direction)).transpose()?,
        up: up.map(|up| unit("up", up)).transpose()?,
    };
    let seen = match asked {
        PictureSpec { direction: None, up: None } => stage.view,
        // without an `up` of its own, the scene's
        _ => asked.view(-stage.view.up),
    };
    let mut view = View { eye, ..View::along(seen.direction, seen.up) };
    if let Some(angle) = arguments.field_of_view {
        if !(1.0..=140.0).contains(&angle) {
            let message = format!("the field of view is {angle} degrees");
            return Err(Refusal::request("field_of_view", angle.to_string(), "1 to 140", message));
        }
        view.field_of_view = angle.to_radians();
    }
    view.light = arguments.light.map(|light| unit("light", Vec3::from_array(light))).transpose()?;
    Ok(view)
}
