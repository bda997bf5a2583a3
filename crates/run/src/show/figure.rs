//! How a run is drawn: from where, in what colours, cut open, taken apart, with arrows.

use std::sync::Arc;

use souple_io::gltf::{Animation, MovingSurface};
use souple_io::picture::{
    ArrowKey, Backdrop, Between, Colour, ColourMap, ColourScale, Cut, ELEMENT_KINDS, EdgeStyle, Ground,
    Label, Legend, LegendPlace, Marks, MeshSurface, Paint, Picture, Stroke, StrokeShape, Surface, Texture,
    Theme, View,
};
use souple_math::Vec3;
use souple_scene::spec::picture::PictureView;

use super::common::Common;
use super::quantity::{Quantity, number_of};
use super::{BodyMoment, Moment, Show, ShowError, Stage, vectors};

/// Everything that a person may ask of a picture of a run.
#[derive(Clone, Debug, PartialEq)]
pub struct Figure {
    /// Width and height [pixels].
    pub size: [usize; 2],
    pub samples_per_pixel: usize,
    pub theme: Theme,
    pub backdrop: Backdrop,
    pub floor: Floor,
    /// None is drawn where `None`.
    pub legend: Option<LegendPlace>,
    pub marks: Marks,
    /// In place of the scene's title; none if empty.
    pub title: Option<String>,
    /// Whether the time of a moment stands under the title.
    pub clock: bool,
    /// In place of the scene's, with everything in it; `bounds` are filled in where `None`.
    pub view: Option<View>,
    /// A field, its magnitude or component; one colour where `None`.
    pub colour_by: Option<String>,
    pub colours: ColourMap,
    pub scale: ColourScale,
    /// Values of the first and the last colour.
    pub range: Option<(f64, f64)>,
    pub cut: Option<Cut>,
    /// How far cells are moved apart, as a part of their distance from the middle.
    pub explode: f64,
    /// How much smaller each cell is drawn, about its own middle.
    pub shrink: f64,
    pub arrows: Option<Arrows>,
    pub edges: EdgeStyle,
    pub frame_axes: FrameAxes,
    pub worn: Worn,
    /// Height of letters, in those of a picture that is looked at by itself.
    pub letters: f64,
}

/// What shadows fall on where the scene has no ground.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Floor {
    #[default]
    None,
    /// A floor a little below the bodies, which touches nothing and is in the picture alone.
    Below,
}

/// How the frames that carry a body are shown.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum FrameAxes {
    /// Three arrows each.
    #[default]
    Drawn,
    /// With their numbers, as `frames.bones` and `frames.shown` of a scene name them.
    Numbered,
    Hidden,
}

/// How much is seen of a body that wears a skin.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Worn {
    #[default]
    Whole,
    /// Its arrows, on the skin that hides it.
    Arrows,
}

/// How far below the bodies, as a part of their size: near enough for their shade, clear of touching.
const FLOOR_GAP: f64 = 0.03;

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
            backdrop: Backdrop::default(),
            floor: Floor::default(),
            legend: Some(LegendPlace::default()),
            marks: Marks::default(),
            title: None,
            clock: true,
            view: None,
            colour_by: Some("von_mises".to_owned()),
            colours: ColourMap::default(),
            scale: ColourScale::default(),
            range: None,
            cut: None,
            explode: 0.0,
            shrink: 0.0,
            arrows: None,
            edges: EdgeStyle::Drawn,
            frame_axes: FrameAxes::default(),
            worn: Worn::default(),
            letters: 1.0,
        }
    }
}

/// Bodies in colours of their own, where no field colours them.
const BODIES: [[u8; 3]; 5] =
    [[214, 122, 104], [112, 150, 196], [160, 178, 96], [206, 168, 96], [160, 128, 184]];
/// Links in a state beyond that of the start: yielded ones are amber.
const STATES: [[u8; 3]; 5] = [[230, 170, 40], [88, 164, 120], [170, 96, 180], [60, 130, 190], [190, 90, 60]];
/// Bodies without values, where a quantity colours others.
const NO_VALUE: [u8; 3] = [172, 174, 178];
const ARROW: [u8; 3] = [40, 44, 52];
/// The same on a dark backdrop.
const ARROW_ON_DARK: [u8; 3] = [236, 238, 242];
/// Axes x, y, z of frames.
const AXES: [[u8; 3]; 3] = [[200, 48, 48], [40, 150, 70], [50, 90, 210]];
/// Their length next to all that is seen.
const AXIS: f64 = 0.03;
/// Most arrows of a body: more hide it, and fewer in a smaller picture, by its lesser side; but so many at least.
const MOST_ARROWS: f64 = 400.0;
const ROOM_OF_ARROWS: f64 = 800.0;
const LEAST_ARROWS: f64 = 40.0;
/// Most dots of a body.
const MOST_DOTS: usize = 100_000;

/// Where an arrow begins [m], and the vector that it shows.
#[derive(Clone, Copy, Debug)]
pub(super) struct Foot {
    from: Vec3,
    vector: Vec3,
}

impl Foot {
    /// How much of the field it shows.
    pub fn length(self) -> f64 {
        self.vector.length()
    }

    /// Where it ends, at so many metres for each unit of the field.
    pub fn tip(self, scale: f64) -> Vec3 {
        self.from + self.vector * scale
    }
}

impl Figure {
    /// Pictures of all moments of a show, in one frame and one range of colours, and what is to be said of them.
    ///
    /// # Errors
    /// A field that no body has.
    pub fn pictures(&self, show: &Show) -> Result<(Vec<Picture>, Vec<String>), ShowError> {
        let moments: Vec<&Moment> = show.moments.iter().collect();
        let common = Common::of(self, show, &moments)?;
        let picture = |moment: &Moment| self.picture_in(&show.stage, moment, &common);
        Ok((show.moments.iter().map(picture).collect(), common.notes))
    }

    /// The picture of one moment, its own frame and range.
    ///
    /// # Errors
    /// A field that no body has.
    pub fn picture(&self, show: &Show, moment: &Moment) -> Result<Picture, ShowError> {
        let common = Common::of(self, show, &[moment])?;
        Ok(self.picture_in(&show.stage, moment, &common))
    }

    pub(super) fn quantity(&self) -> Option<Quantity<'_>> {
        self.colour_by.as_deref().map(Quantity::parse)
    }

    /// The picture of one moment of several, in the frame and the range of all.
    pub fn picture_in(&self, stage: &Stage, moment: &Moment, common: &Common) -> Picture {
        let mut surfaces = Vec::new();
        let (mut strokes, mut labels) = (Vec::new(), Vec::new());
        let mut has_dots = false;
        let all = moment.bodies.iter().filter(|body| body.is_drawable());
        for body in all {
            strokes.extend(common.arrow_scale.iter().flat_map(|scale| self.arrows_of(body, *scale)));
        }
        // colours of bodies go by their number among those that are seen
        let seen = moment.bodies.iter().filter(|body| !self.hides(moment, body)).enumerate();
        for (index, body) in seen.filter(|(_, body)| body.is_drawable()) {
            surfaces.extend(self.surfaces(body, index, common, stage.texture(&body.name)));
            for (number, frame) in
                body.frames.iter().enumerate().filter(|(_, [origin, ..])| self.is_left(*origin))
            {
                if self.frame_axes != FrameAxes::Hidden {
                    strokes.extend(axes_of(frame, AXIS * common.bounds.diagonal()));
                }
                if self.frame_axes == FrameAxes::Numbered {
                    labels.push(Label { at: frame[0], text: number.to_string() });
                }
            }
            let dots = self.dots_of(body, moment.faces_of(body), (index, common.range));
            has_dots |= !dots.is_empty();
            strokes.extend(dots);
        }
        // what is cut away whole needs no legend
        let is_coloured = |of: &Surface| {
            !matches!(of.paint, Paint::Plain(_))
                && (has_dots || !of.triangles.is_empty() || !of.balls.is_empty())
        };
        let coloured = surfaces.iter().any(is_coloured);
        surfaces.extend(stage.surfaces(moment.time, common.bounds));
        let legend = self.quantity().filter(|_| coloured).zip(self.legend).map(|(quantity, place)| Legend {
            title: quantity.title(),
            unit: quantity.unit().to_owned(),
            range: common.range,
            place,
            names: self.names_of(moment),
            beyond: common.beyond,
        });
        let key = self.arrows.as_ref().zip(common.arrow_scale).map(|(arrows, scale)| {
            let quantity = Quantity::parse(&arrows.field);
            ArrowKey { title: quantity.title(), unit: quantity.unit().to_owned(), scale }
        });
        let PictureView { direction, up } = stage.view;
        let view = self.view.unwrap_or_else(|| View::along(direction, up));
        Picture {
            surfaces,
            strokes,
            ground: stage.ground(moment.time).or_else(|| self.floor_below(common, up)),
            framed: if view.bounds.is_some() { Vec::new() } else { common.framed.clone() },
            view: View { bounds: view.bounds.or(Some(common.bounds)), ..view },
            size: self.size,
            samples_per_pixel: self.samples_per_pixel,
            theme: self.theme,
            backdrop: self.backdrop,
            title: self.title.clone().unwrap_or_else(|| stage.title.clone()),
            subtitle: if self.clock {
                format!("{:.*} s", common.time_digits, moment.time)
            } else {
                String::new()
            },
            legend,
            colours: self.colours,
            scale: self.scale,
            marks: self.marks,
            labels,
            key,
            letters: self.letters,
        }
    }

    /// Whether a body is not seen, as the skin that it wears is; or one of the two, as the other is in the colours that are asked for.
    pub fn hides(&self, moment: &Moment, body: &BodyMoment) -> bool {
        if self.worn == Worn::Arrows {
            return moment.skin_of(body).is_some();
        }
        let looks_inside = self.cut.is_some() || self.explode > 0.0 || self.shrink > 0.0;
        let Some(quantity) = self.quantity().filter(|_| !looks_inside) else { return false };
        match (moment.skin_of(body), moment.wearer_of(body)) {
            // where both have it the edges of one would come through the other
            (Some(skin), _) => quantity.is_of_worn(skin),
            (None, Some(wearer)) => quantity.is_of(wearer) && !quantity.is_of_worn(body),
            (None, None) => false,
        }
    }

    /// What values are called: where colours stand for kinds of elements, those there are, with how many; where they are how tissue looks,
    /// its states.
    fn names_of(&self, moment: &Moment) -> Vec<(f64, String)> {
        match self.colours {
            ColourMap::Tissue => TISSUE_STATES.map(|(value, name)| (value, name.to_owned())).into(),
            ColourMap::Elements => self.names_of_elements(moment),
            _ => Vec::new(),
        }
    }

    /// Of the bodies that are seen.
    fn names_of_elements(&self, moment: &Moment) -> Vec<(f64, String)> {
        let mut counts = [0; ELEMENT_KINDS.len()];
        let seen = moment.bodies.iter().filter(|body| !self.hides(moment, body));
        for cell in seen.flat_map(|body| body.mesh.cells()) {
            counts[number_of(cell.kind)] += 1;
        }
        let named = counts.iter().zip(ELEMENT_KINDS).enumerate().filter(|(_, (count, _))| **count > 0);
        named.map(|(number, (count, name))| (number as f64, format!("{count} {name}"))).collect()
    }

    /// Whether a point is not cut away.
    pub(super) fn is_left(&self, point: Vec3) -> bool {
        self.cut.is_none_or(|cut| (point - cut.point).dot(cut.normal) <= 0.0)
    }

    fn floor_below(&self, common: &Common, up: Vec3) -> Option<Ground> {
        // bodies that are taken apart are framed by their bounds
        let corners = common.bounds.corners().map(|corner| corner.dot(up));
        let framed = common.framed.iter().map(|ball| ball.centre.dot(up) - ball.radius).reduce(f64::min);
        let lowest = framed.or_else(|| corners.reduce(f64::min))?;
        let height = lowest - FLOOR_GAP * common.bounds.diagonal();
        (self.floor == Floor::Below).then(|| Ground { point: up * height, normal: up })
    }

    /// What is seen of a body: its surface, or its links, those of each state in a colour, and its balls.
    fn surfaces(
        &self,
        body: &BodyMoment,
        index: usize,
        common: &Common,
        texture: Option<&Arc<Texture>>,
    ) -> Vec<Surface> {
        let quantity = self.quantity();
        // colours that are read have none of a texture in them
        let is_look = quantity.as_ref().is_none_or(Quantity::is_look);
        let texture = texture.filter(|_| is_look && !body.is_of_edges());
        let is_coloured = quantity.is_some();
        let film = body.film().filter(|_| quantity.as_ref().is_some_and(Quantity::is_look));
        let values = quantity.as_ref().and_then(|quantity| quantity.at_points(body));
        // colours with a meaning of their own are not mixed between cells
        let by_cell = quantity.filter(|_| self.colours.own_range().is_some() && !body.is_of_edges());
        let by_cell = by_cell.and_then(|quantity| quantity.at_cells(body));
        let painted = |mut of: MeshSurface, state: u8| {
            match (&by_cell, &values) {
                (Some(values), _) => of.paint_cells(values),
                (None, Some(values)) => of.paint_points(values),
                // no colour of the scale is what has no value
                (None, None) if is_coloured => of.surface.paint = Paint::Plain(Colour::from_screen(NO_VALUE)),
                (None, None) => of.surface.paint = Paint::Plain(colour_of(index, state)),
            }
            if let Some(film) = film {
                of.cover(film);
            }
            if let Some(texture) = texture {
                of.texture(texture, &body.rest());
            }
            of.surface
        };
        let mut surfaces = match body.link_states().filter(|_| values.is_none()) {
            Some(states) => {
                let present = |state: &u8| states.contains(&f64::from(*state));
                let tubes = |state: u8| painted(body.tubes(common, self.cut, Some(f64::from(state))), state);
                (0..=u8::MAX).filter(present).map(tubes).collect()
            }
            None if values.is_none() && by_cell.is_none() && body.parts().is_some() => body
                .split_by_part()
                .iter()
                .enumerate()
                .map(|(part, body)| {
                    let mut surface = self.surface(body, common).surface;
                    surface.paint = match is_coloured {
                        true => Paint::Plain(Colour::from_screen(NO_VALUE)),
                        false => Paint::Plain(colour_of(index + part, 0)),
                    };
                    surface
                })
                .collect(),
            None => vec![painted(self.surface(body, common), 0)],
        };
        if let Some(radii) = body.radii() {
            let grounds = body.grounds();
            let seen =
                radii.iter().zip(&grounds).map(|(radius, is_ground)| if *is_ground { 0.0 } else { *radius });
            let seen: Vec<f64> = seen.collect();
            let (mut of, from) = Surface::of_balls(&body.positions, &seen, self.cut);
            of.paint = match &values {
                Some(values) => {
                    Paint::PointScalar(from.iter().map(|point| values[*point as usize]).collect())
                }
                None if is_coloured => Paint::Plain(Colour::from_screen(NO_VALUE)),
                None => Paint::Plain(colour_of(index, 0)),
            };
            surfaces.push(of);
        }
        surfaces
    }

    fn surface(&self, body: &BodyMoment, common: &Common) -> MeshSurface {
        if body.is_of_edges() {
            return body.tubes(common, self.cut, None);
        }
        let mut surface = self.bare_surface(body);
        if body.parts().is_some() {
            surface.hide_flat_edges();
        }
        let hides = body.is_skin() && self.edges == EdgeStyle::Drawn;
        surface.surface.edge_style = if hides { EdgeStyle::Hidden } else { self.edges };
        surface
    }

    /// The surface of a body where it is drawn, cut and taken apart; edges as lines without width, which stay together.
    fn bare_surface(&self, body: &BodyMoment) -> MeshSurface {
        let [explode, shrink] = if body.is_of_edges() { [0.0; 2] } else { [self.explode, self.shrink] };
        let mut surface = match self.cut {
            Some(cut) if explode > 0.0 => MeshSurface::of_cells_left(&body.mesh, &body.positions, cut),
            Some(cut) => MeshSurface::cut(&body.mesh, &body.positions, cut),
            None if explode > 0.0 || shrink > 0.0 => MeshSurface::of_cells(&body.mesh),
            None => MeshSurface::of(&body.mesh),
        };
        surface.move_to(&body.positions);
        if explode > 0.0 {
            surface.explode(explode);
        }
        if self.cut.is_none() && shrink > 0.0 {
            surface.shrink(shrink);
        }
        surface
    }

    /// Masses without a size that no edge joins and that are of no faces, as dots; what edges join is drawn as tubes.
    fn dots_of(
        &self,
        body: &BodyMoment,
        faces: Option<&BodyMoment>,
        (index, range): (usize, Option<(f64, f64)>),
    ) -> Vec<Stroke> {
        if !body.is_of_edges() && body.mesh.cell_count() > 0 {
            return Vec::new();
        }
        let values = self.quantity().and_then(|quantity| quantity.at_points(body));
        let range = range.unwrap_or((0.0, 1.0));
        let colour = |point: u32| match &values {
            Some(values) => self.colours.colour(self.scale.share(values[point as usize], range)),
            None => colour_of(index, 0),
        };
        let is_ball = |point: usize| body.radii().is_some_and(|radii| radii[point] > 0.0);
        let mut is_loose: Vec<bool> = (0..body.positions.len()).map(|point| !is_ball(point)).collect();
        let joined = std::iter::once(body).chain(faces).flat_map(|body| body.mesh.cells());
        for node in joined.flat_map(|cell| cell.nodes) {
            is_loose[*node as usize] = false;
        }
        let loose = (0..body.positions.len() as u32).filter(|point| is_loose[*point as usize]);
        let every = loose.clone().count().div_ceil(MOST_DOTS).max(1);
        let dot = |point: u32| {
            let shape = StrokeShape::Dot(body.positions[point as usize]);
            Stroke { shape, colour: colour(point), width: 8.0, through: Stroke::FAINTLY }
        };
        loose.step_by(every).map(dot).collect()
    }

    /// Where arrows begin and what they show, of as many points of a body as are drawn.
    pub(super) fn feet_of(&self, body: &BodyMoment) -> Vec<Foot> {
        let Some(field) = self.arrows.as_ref().and_then(|arrows| vectors(body, &arrows.field)) else {
            return Vec::new();
        };
        let surface = self.bare_surface(body);
        // a field has no values in the middles of curved cells, where a cut has points
        let has_value = |(of, _): &(Between, Vec3)| (of.from.max(of.to) as usize) < field.len();
        let mut points: Vec<(Between, Vec3)> =
            surface.points.into_iter().zip(surface.surface.points).filter(has_value).collect();
        // particles have no surface: all of their points are seen
        if points.is_empty() {
            let all = body.positions.iter().enumerate().filter(|(_, x)| self.is_left(**x));
            points = all.map(|(point, x)| (Between::at(point as u32), *x)).collect();
        }
        let room = self.size[0].min(self.size[1]) as f64 / ROOM_OF_ARROWS;
        let most = (MOST_ARROWS * room * room).clamp(LEAST_ARROWS, MOST_ARROWS) as usize;
        let every = points.len().div_ceil(most).max(1);
        let foot = |(point, place): (Between, Vec3)| {
            let vector = point.of(&field);
            // a ball hides what is within: an arrow begins where it leaves it
            let radius = body.radii().map_or(0.0, |radii| point.of(radii).max(0.0));
            let from = place + vector.try_normalised()? * radius;
            (vector.is_finite() && from.is_finite()).then_some(Foot { from, vector })
        };
        points.into_iter().step_by(every).filter_map(foot).collect()
    }

    fn arrows_of(&self, body: &BodyMoment, scale: f64) -> Vec<Stroke> {
        let colour = Colour::from_screen(match self.theme {
            Theme::Light => ARROW,
            Theme::Dark => ARROW_ON_DARK,
        });
        let stroke = |foot: Foot| {
            let shape = StrokeShape::Arrow(foot.from, foot.tip(scale));
            Stroke { shape, colour, width: 2.0, through: Stroke::FAINTLY }
        };
        self.feet_of(body).into_iter().map(stroke).collect()
    }

    /// The boundaries of all bodies and shapes over all moments, coloured as at the last, and what is to be said of them.
    pub fn animation(&self, show: &Show) -> Result<(Animation, Vec<String>), ShowError> {
        let moments: Vec<&Moment> = show.moments.iter().filter(|moment| moment.is_drawable()).collect();
        let common = Common::of(self, show, &moments)?;
        let count = moments.last().map_or(0, |moment| moment.bodies.len());
        let mut surfaces = Vec::new();
        for index in 0..count {
            let bodies: Vec<&BodyMoment> =
                moments.iter().filter_map(|moment| moment.bodies.get(index)).collect();
            surfaces.extend(self.moving(&bodies, index, &common));
        }
        let scenery = |time: f64| show.stage.surfaces(time, common.bounds);
        let first = moments.first().map_or_else(Vec::new, |moment| scenery(moment.time));
        for (index, Surface { triangles, .. }) in first.into_iter().enumerate() {
            surfaces.push(MovingSurface {
                name: format!("shape {}", index + 1),
                triangles,
                during: 0..moments.len(),
                frames: moments
                    .iter()
                    .filter_map(|m| scenery(m.time).into_iter().nth(index))
                    .map(|s| s.points)
                    .collect(),
                colour: Colour::from_screen([150, 158, 170]),
                point_colours: Vec::new(),
            });
        }
        let times = moments.iter().map(|moment| moment.time).collect();
        Ok((Animation { surfaces, times, up: show.stage.view.up }, common.notes))
    }
}

impl Figure {
    /// A body over all moments: a surface for each run of moments in which its triangles stay the same, coloured as at the
    /// last of them. Those of a skin are others at each moment.
    fn moving(&self, bodies: &[&BodyMoment], index: usize, common: &Common) -> Vec<MovingSurface> {
        let range = common.range.unwrap_or((0.0, 1.0));
        let colour = |value: f64| self.colours.colour(self.scale.share(value, range));
        let mut all: Vec<MovingSurface> = Vec::new();
        let mut of: Option<(&BodyMoment, MeshSurface)> = None;
        for (at, body) in bodies.iter().enumerate() {
            let surface = match of.take() {
                Some((before, surface)) if !body.is_of_edges() && before.has_mesh_of(body) => surface,
                _ if body.is_of_edges() => body.tubes(common, None, None),
                _ => MeshSurface::of(&body.mesh),
            };
            let mut moved = surface.clone();
            if !body.is_of_edges() {
                moved.move_to(&body.positions);
            }
            let positions = moved.surface.points;
            let goes_on = |last: &&mut MovingSurface| {
                last.triangles == surface.surface.triangles && last.frames[0].len() == positions.len()
            };
            match all.last_mut().filter(goes_on) {
                Some(last) => {
                    last.during.end = at + 1;
                    last.frames.push(positions);
                }
                None => all.push(MovingSurface {
                    name: body.name.clone(),
                    triangles: surface.surface.triangles.clone(),
                    during: at..at + 1,
                    frames: vec![positions],
                    colour: colour_of(index, 0),
                    point_colours: Vec::new(),
                }),
            }
            let is_last = bodies.get(at + 1).is_none_or(|next| body.is_of_edges() || !body.has_mesh_of(next));
            if let (true, Some(run)) = (is_last, all.last_mut())
                && let Some(values) = self.quantity().and_then(|quantity| quantity.at_points(body))
            {
                run.point_colours =
                    surface.points.iter().map(|point| colour(values[point.from as usize])).collect();
            }
            of = Some((body, surface));
        }
        // nothing is there where a skin has gone, or all links are torn
        all.retain(|surface| !surface.triangles.is_empty());
        all
    }
}

/// Values of [`ColourMap::Tissue`] and what they are.
const TISSUE_STATES: [(f64, &str); 3] = [(-1.0, "charred"), (0.0, "untouched"), (1.0, "pressed white")];

/// The colour of a body, or of those of its links that are in another state than at the start.
fn colour_of(body: usize, state: u8) -> Colour {
    let of_state = usize::from(state).checked_sub(1).map(|number| STATES[number % STATES.len()]);
    Colour::from_screen(of_state.unwrap_or(BODIES[body % BODIES.len()]))
}

/// A frame that carries a body: three arrows.
fn axes_of([origin, axes @ ..]: &[Vec3; 4], length: f64) -> impl Iterator<Item = Stroke> + '_ {
    axes.iter().zip(AXES).map(move |(axis, colour)| Stroke {
        shape: StrokeShape::Arrow(*origin, *origin + *axis * length),
        colour: Colour::from_screen(colour),
        width: 2.0,
        // they are inside it
        through: Stroke::PLAINLY,
    })
}
