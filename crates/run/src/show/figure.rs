//! How a run is drawn: from where, in what colours, cut open, taken apart, with arrows.

use souple_io::gltf::{Animation, MovingSurface};
use souple_io::picture::{
    Colour, ColourMap, Cut, EdgeStyle, Legend, MeshSurface, Paint, Picture, Stroke, StrokeShape, Surface,
    Theme, View,
};
use souple_math::Vec3;
use souple_mesh::BoundingBox;
use souple_scene::spec::picture::PictureView;

use super::quantity::Quantity;
use super::{BodyMoment, Moment, Show, ShowError};

/// Everything that a person may ask of a picture of a run.
#[derive(Clone, Debug, PartialEq)]
pub struct Figure {
    /// Width and height [pixels].
    pub size: [usize; 2],
    pub samples_per_pixel: usize,
    pub theme: Theme,
    /// In place of the scene's title; none if empty.
    pub title: Option<String>,
    /// In place of the scene's, with everything in it; `bounds` are filled in where `None`.
    pub view: Option<View>,
    /// A field, its magnitude or component; one colour where `None`.
    pub colour_by: Option<String>,
    pub colours: ColourMap,
    /// Values of the first and the last colour.
    pub range: Option<(f64, f64)>,
    pub cut: Option<Cut>,
    /// How far cells are moved apart, as a part of their distance from the middle.
    pub explode: f64,
    pub arrows: Option<Arrows>,
    pub edges: EdgeStyle,
}

/// Arrows of a vector field at points of the surface.
#[derive(Clone, Debug, PartialEq)]
pub struct Arrows {
    pub field: String,
    /// Metres of arrow for each unit of the field; so that the longest is a sixth of the bodies where `None`.
    pub scale: Option<f64>,
}

impl Default for Figure {
    fn default() -> Self {
        Self {
            size: [1280, 800],
            samples_per_pixel: 3,
            theme: Theme::default(),
            title: None,
            view: None,
            colour_by: Some("von_mises".to_owned()),
            colours: ColourMap::default(),
            range: None,
            cut: None,
            explode: 0.0,
            arrows: None,
            edges: EdgeStyle::Drawn,
        }
    }
}

/// What all pictures of a show have in common, so that neither camera nor colours jump.
#[derive(Clone, Copy, Debug)]
struct Common {
    bounds: BoundingBox,
    range: Option<(f64, f64)>,
    arrow_scale: f64,
}

/// Values that differ by less than this part of the largest are one value: solvers stop some digits before rounding.
const ONE_VALUE: f64 = 1e-6;

/// The range of colours for values from `low` to `high`: from zero where all are one value but for rounding.
fn spread((low, high): (f64, f64)) -> (f64, f64) {
    let most = low.abs().max(high.abs());
    if high - low > ONE_VALUE * most { (low, high) } else { (low.min(0.0), high.max(0.0)) }
}

/// Bodies in colours of their own, where no field colours them.
const BODIES: [[u8; 3]; 5] =
    [[214, 122, 104], [112, 150, 196], [160, 178, 96], [206, 168, 96], [160, 128, 184]];
const ARROW: [u8; 3] = [40, 44, 52];
/// Most arrows of a body: more hide it.
const MOST_ARROWS: usize = 400;
/// Most lines or dots of a body.
const MOST_LINES: usize = 100_000;

impl Figure {
    /// Pictures of all moments of a show, in one frame and one range of colours.
    ///
    /// # Errors
    /// A field that no body has.
    pub fn pictures(&self, show: &Show) -> Result<Vec<Picture>, ShowError> {
        let moments: Vec<&Moment> = show.moments.iter().collect();
        let common = self.common(show, &moments)?;
        Ok(moments.into_iter().map(|moment| self.picture_in(show, moment, &common)).collect())
    }

    /// The picture of one moment, its own frame and range.
    ///
    /// # Errors
    /// A field that no body has.
    pub fn picture(&self, show: &Show, moment: &Moment) -> Result<Picture, ShowError> {
        let common = self.common(show, &[moment])?;
        Ok(self.picture_in(show, moment, &common))
    }

    fn common(&self, show: &Show, moments: &[&Moment]) -> Result<Common, ShowError> {
        let bodies = || moments.iter().flat_map(|moment| &moment.bodies).filter(|body| body.is_finite());
        let mut bounds = BoundingBox::of(bodies().flat_map(|body| body.positions.iter().copied()));
        for moment in moments {
            if let Some(shapes) = show.stage.bounds(moment.time, bounds) {
                bounds = bounds.union(shapes);
            }
        }
        // exploded bodies are larger about their middles; those of all bodies together are near enough
        if self.explode > 0.0 {
            bounds = bounds.grown(0.5 * self.explode * bounds.diagonal() / 3f64.sqrt());
        }
        let mut range = self.range;
        if let Some(quantity) = self.quantity() {
            if let Some(first) = moments.first() {
                quantity.check(first)?;
            }
            let values =
                bodies().filter_map(|body| quantity.at_points(body)).flatten().filter(|v| v.is_finite());
            let of_values = values.fold(None, |range: Option<(f64, f64)>, value| match range {
                None => Some((value, value)),
                Some((low, high)) => Some((low.min(value), high.max(value))),
            });
            range = range.or(of_values.map(spread));
            if let (ColourMap::Diverging, None, Some((low, high))) = (self.colours, self.range, range) {
                let most = low.abs().max(high.abs());
                range = Some((-most, most));
            }
        }
        let mut arrow_scale = 1.0;
        if let Some(arrows) = &self.arrows {
            if let Some(first) = moments.first() {
                vectors_of(first, &arrows.field)?;
            }
            let lengths =
                bodies().filter_map(|body| vectors(body, &arrows.field)).flatten().map(|v| v.length());
            let longest = lengths.filter(|length| length.is_finite()).fold(0.0, f64::max);
            let fitted = if longest > 0.0 { bounds.diagonal() / (6.0 * longest) } else { 1.0 };
            arrow_scale = arrows.scale.unwrap_or(fitted);
        }
        Ok(Common { bounds, range, arrow_scale })
    }

    fn quantity(&self) -> Option<Quantity<'_>> {
        self.colour_by.as_deref().map(Quantity::parse)
    }

    fn picture_in(&self, show: &Show, moment: &Moment, common: &Common) -> Picture {
        let mut surfaces = Vec::new();
        let mut strokes = Vec::new();
        for (index, body) in moment.bodies.iter().enumerate().filter(|(_, body)| body.is_finite()) {
            surfaces.push(self.surface(body, index).surface);
            strokes.extend(self.arrows_of(body, common.arrow_scale));
            strokes.extend(self.lines_of(body, index, common.range));
        }
        let coloured = surfaces.iter().any(|surface| !matches!(surface.paint, Paint::Plain(_)));
        surfaces.extend(show.stage.surfaces(moment.time, common.bounds));
        let legend = self.quantity().filter(|_| coloured).map(|quantity| Legend {
            title: quantity.title(),
            unit: quantity.unit().to_owned(),
            range: common.range,
        });
        let PictureView { direction, up } = show.stage.view;
        let view = self.view.unwrap_or_else(|| View::along(direction, up));
        Picture {
            surfaces,
            strokes,
            ground: show.stage.ground(moment.time),
            view: View { bounds: view.bounds.or(Some(common.bounds)), ..view },
            size: self.size,
            samples_per_pixel: self.samples_per_pixel,
            theme: self.theme,
            title: self.title.clone().unwrap_or_else(|| show.stage.title.clone()),
            subtitle: format!("{:.3} s", moment.time),
            legend,
            colours: self.colours,
        }
    }

    fn surface(&self, body: &BodyMoment, index: usize) -> MeshSurface {
        let mut surface = match self.cut {
            Some(cut) => MeshSurface::cut(&body.mesh, &body.positions, cut),
            None if self.explode > 0.0 => MeshSurface::of_cells(&body.mesh),
            None => MeshSurface::of(&body.mesh),
        };
        surface.move_to(&body.positions);
        if self.cut.is_none() && self.explode > 0.0 {
            surface.explode(self.explode);
        }
        match self.quantity().and_then(|quantity| quantity.at_points(body)) {
            Some(values) => surface.paint_points(&values),
            None => surface.surface.paint = Paint::Plain(Colour::from_screen(BODIES[index % BODIES.len()])),
        }
        surface.surface.edge_style = self.edges;
        surface
    }

    /// Edges as lines, and points that are in no cell as dots: surfaces show nothing of them.
    fn lines_of(&self, body: &BodyMoment, index: usize, range: Option<(f64, f64)>) -> Vec<Stroke> {
        let is_of_edges = body.mesh.dimension() == 1;
        if !is_of_edges && body.mesh.cell_count() > 0 {
            return Vec::new();
        }
        let values = self.quantity().and_then(|quantity| quantity.at_points(body));
        let (low, high) = range.unwrap_or((0.0, 1.0));
        let colour = |point: u32| match &values {
            Some(values) => {
                self.colours.colour((values[point as usize] - low) / (high - low).max(f64::MIN_POSITIVE))
            }
            None => Colour::from_screen(BODIES[index % BODIES.len()]),
        };
        let at = |point: u32| body.positions[point as usize];
        let mut is_dot = vec![true; body.positions.len()];
        let mut strokes = Vec::new();
        let every = body.mesh.cell_count().div_ceil(MOST_LINES).max(1);
        for (number, cell) in body.mesh.cells().enumerate() {
            cell.nodes.iter().for_each(|node| is_dot[*node as usize] = false);
            if number % every == 0 {
                let shape = StrokeShape::Line(vec![at(cell.nodes[0]), at(cell.nodes[1])]);
                strokes.push(Stroke { shape, colour: colour(cell.nodes[0]), width: 1.5 });
            }
        }
        let dots = (0..body.positions.len() as u32).filter(|point| is_dot[*point as usize]);
        let every = dots.clone().count().div_ceil(MOST_LINES).max(1);
        strokes.extend(dots.step_by(every).map(|point| Stroke {
            shape: StrokeShape::Dot(at(point)),
            colour: colour(point),
            width: 8.0,
        }));
        strokes
    }

    fn arrows_of(&self, body: &BodyMoment, scale: f64) -> Vec<Stroke> {
        let Some(field) = self.arrows.as_ref().and_then(|arrows| vectors(body, &arrows.field)) else {
            return Vec::new();
        };
        let points = MeshSurface::of(&body.mesh).points;
        let every = points.len().div_ceil(MOST_ARROWS).max(1);
        let stroke = |point: &souple_io::picture::Between| {
            let (from, vector) = (body.positions[point.from as usize], field[point.from as usize] * scale);
            let shape = StrokeShape::Arrow(from, from + vector);
            vector.is_finite().then(|| Stroke { shape, colour: Colour::from_screen(ARROW), width: 2.0 })
        };
        points.iter().step_by(every).filter_map(stroke).collect()
    }

    /// The boundaries of all bodies and shapes over all moments, coloured as at the last.
    pub fn animation(&self, show: &Show) -> Result<Animation, ShowError> {
        let moments: Vec<&Moment> = show.moments.iter().collect();
        let common = self.common(show, &moments)?;
        let count = moments.last().map_or(0, |moment| moment.bodies.len());
        let mut surfaces = Vec::new();
        for index in 0..count {
            let bodies: Vec<&BodyMoment> =
                moments.iter().filter_map(|moment| moment.bodies.get(index)).collect();
            let Some(last) = bodies.last() else { continue };
            let of = MeshSurface::of(&last.mesh);
            let frame = |body: &&BodyMoment| {
                let mut surface = of.clone();
                surface.move_to(&body.positions);
                surface.surface.points
            };
            let values = self.quantity().and_then(|quantity| quantity.at_points(last));
            let (low, high) = common.range.unwrap_or((0.0, 1.0));
            let colour =
                |value: f64| self.colours.colour((value - low) / (high - low).max(f64::MIN_POSITIVE));
            surfaces.push(MovingSurface {
                name: last.name.clone(),
                triangles: of.surface.triangles.clone(),
                frames: bodies.iter().map(frame).collect(),
                colour: Colour::from_screen(BODIES[index % BODIES.len()]),
                point_colours: values.map_or_else(Vec::new, |values| {
                    of.points.iter().map(|point| colour(values[point.from as usize])).collect()
                }),
            });
        }
        let scenery = |time: f64| show.stage.surfaces(time, common.bounds);
        let first = moments.first().map_or_else(Vec::new, |moment| scenery(moment.time));
        for (index, Surface { triangles, .. }) in first.into_iter().enumerate() {
            surfaces.push(MovingSurface {
                name: format!("shape {}", index + 1),
                triangles,
                frames: moments
                    .iter()
                    .filter_map(|m| scenery(m.time).into_iter().nth(index))
                    .map(|s| s.points)
                    .collect(),
                colour: Colour::from_screen([150, 158, 170]),
                point_colours: Vec::new(),
            });
        }
        Ok(Animation {
            surfaces,
            times: moments.iter().map(|moment| moment.time).collect(),
            up: show.stage.view.up,
        })
    }
}

/// A field of three numbers on the points.
fn vectors(body: &BodyMoment, name: &str) -> Option<Vec<Vec3>> {
    let field = body.point_fields.iter().find(|field| field.name == name && field.components == 3)?;
    Some(field.values.chunks_exact(3).map(|v| Vec3::new(v[0], v[1], v[2])).collect())
}

/// Refuses a vector field that no body has.
fn vectors_of(moment: &Moment, name: &str) -> Result<(), ShowError> {
    if moment.bodies.iter().any(|body| vectors(body, name).is_some()) {
        return Ok(());
    }
    let fields =
        moment.bodies.iter().flat_map(|body| &body.point_fields).filter(|field| field.components == 3);
    let mut known: Vec<&str> = fields.map(|field| field.name.as_str()).collect();
    known.sort_unstable();
    known.dedup();
    let expected = format!("a vector of each point: {}", known.join(", "));
    Err(ShowError::UnknownField { name: name.to_owned(), expected })
}
