//! What the editor does to a transfer function: opacities by nodes of their own, colours by a map or by
//! nodes of their own.

use renderer::{ColourMap, ColourPoint, ControlPoint, MapView, TransferFunction, TransferView};

/// Nodes that a map is turned into where its colours are to be edited.
const NODES: u32 = 9;

/// The function over u; `None` where it is none, which no view in the session is.
pub fn function(transfer: &TransferView) -> Option<TransferFunction> {
    transfer.function().ok()
}

/// Sorts nodes by u: a file may hold them in any order.
pub fn sort(transfer: &mut TransferView) {
    transfer.points.sort_by(|a, b| a.u.total_cmp(&b.u));
    if let Some(map) = &mut transfer.map {
        map.points.sort_by(|a, b| a.u.total_cmp(&b.u));
    }
}

/// The nodes of colour that can be edited, where the colours are not those of a named map.
pub fn colour_nodes(transfer: &TransferView) -> Option<Vec<ColourPoint>> {
    let named = transfer.map.as_ref().is_some_and(|map| map.name.is_some());
    if named { None } else { transfer.colours().ok() }
}

/// Gives the colours nodes of their own, where they were those of the control points.
pub fn split(transfer: &mut TransferView) {
    if transfer.map.is_none()
        && let Ok(points) = transfer.colours()
    {
        transfer.map = Some(MapView { points, ..MapView::default() });
    }
}

/// Sets the nodes of colour, in ascending order of u.
pub fn set_colours(transfer: &mut TransferView, points: Vec<ColourPoint>) {
    transfer.map = Some(MapView { points, ..MapView::default() });
    recolour(transfer);
}

/// Takes the colours of a named map; opacities stay.
pub fn choose_map(transfer: &mut TransferView, map: &ColourMap) {
    let reversed = transfer.map.as_ref().is_some_and(|map| map.name.is_some() && map.reversed);
    transfer.map = Some(MapView { reversed, ..MapView::named(map.name) });
    recolour(transfer);
}

/// Turns a named map into a few nodes of about the same colours.
pub fn free_colours(transfer: &mut TransferView) {
    let Some(function) = function(transfer) else { return };
    let node = |i: u32| {
        let u = i as f32 / (NODES - 1) as f32;
        ColourPoint { u, rgb: colour(&function, u) }
    };
    set_colours(transfer, (0..NODES).map(node).collect());
}

/// Low and high values change their colours.
pub fn reverse_colours(transfer: &mut TransferView) {
    split(transfer);
    if let Some(map) = &mut transfer.map {
        if map.name.is_some() {
            map.reversed = !map.reversed;
        } else {
            map.points.reverse();
            map.points.iter_mut().for_each(|point| point.u = 1.0 - point.u);
        }
    }
    recolour(transfer);
}

/// Low and high values change their opacities.
pub fn reverse_opacities(transfer: &mut TransferView) {
    split(transfer);
    transfer.points.reverse();
    transfer.points.iter_mut().for_each(|point| point.u = 1.0 - point.u);
    recolour(transfer);
}

/// Has the control points say the map's colours, for programs that know nothing of maps.
pub fn recolour(transfer: &mut TransferView) {
    let Some(function) = function(transfer).filter(|_| transfer.map.is_some()) else { return };
    transfer.points.iter_mut().for_each(|point| point.rgb = colour(&function, point.u));
}

/// Moves a node, no farther than its neighbours: at a neighbour's u the two are a step.
pub fn move_opacity(transfer: &mut TransferView, index: usize, u: f32, opacity: f32) {
    split(transfer);
    let us: Vec<f32> = transfer.points.iter().map(|point| point.u).collect();
    transfer.points[index].u = between_neighbours(&us, index, u);
    transfer.points[index].opacity = opacity.clamp(0.0, 1.0);
    recolour(transfer);
}

/// Adds a node. Returns its place in the list.
pub fn add_opacity(transfer: &mut TransferView, u: f32, opacity: f32) -> usize {
    split(transfer);
    let index = transfer.points.partition_point(|point| point.u <= u);
    transfer.points.insert(index, ControlPoint { u, rgb: [1.0; 3], opacity });
    recolour(transfer);
    index
}

/// Removes a node, unless it is the last one: that is the whole function.
pub fn remove_opacity(transfer: &mut TransferView, index: usize) {
    if transfer.points.len() > 1 {
        split(transfer);
        transfer.points.remove(index);
    }
}

/// Moves a node of colour, no farther than its neighbours.
pub fn move_colour(transfer: &mut TransferView, index: usize, u: f32) {
    if let Some(mut nodes) = colour_nodes(transfer) {
        let us: Vec<f32> = nodes.iter().map(|node| node.u).collect();
        nodes[index].u = between_neighbours(&us, index, u);
        set_colours(transfer, nodes);
    }
}

/// Adds a node of the colour that is there. Returns its place in the list.
pub fn add_colour(transfer: &mut TransferView, u: f32) -> Option<usize> {
    let mut nodes = colour_nodes(transfer)?;
    let rgb = colour(&function(transfer)?, u);
    let index = nodes.partition_point(|node| node.u <= u);
    nodes.insert(index, ColourPoint { u, rgb });
    set_colours(transfer, nodes);
    Some(index)
}

/// Gives a node of colour another one.
pub fn paint_colour(transfer: &mut TransferView, index: usize, rgb: [f32; 3]) {
    if let Some(mut nodes) = colour_nodes(transfer) {
        nodes[index].rgb = rgb.map(|channel| channel.clamp(0.0, 1.0));
        set_colours(transfer, nodes);
    }
}

/// Removes a node of colour, unless it is the last one.
pub fn remove_colour(transfer: &mut TransferView, index: usize) {
    if let Some(mut nodes) = colour_nodes(transfer).filter(|nodes| nodes.len() > 1) {
        nodes.remove(index);
        set_colours(transfer, nodes);
    }
}

fn between_neighbours(us: &[f32], index: usize, u: f32) -> f32 {
    let low = if index == 0 { 0.0 } else { us[index - 1] };
    let high = us.get(index + 1).copied().unwrap_or(1.0);
    u.clamp(low, high)
}

fn colour(function: &TransferFunction, u: f32) -> [f32; 3] {
    let [r, g, b, _] = function.sample(u);
    [r, g, b]
}

#[cfg(test)]
mod tests {
    use super::*;

    fn transfer() -> TransferView {
        let point = |u, value, opacity| ControlPoint { u, rgb: [value; 3], opacity };
        TransferView {
            points: vec![point(0.0, 0.0, 0.0), point(0.5, 0.2, 0.5), point(1.0, 1.0, 1.0)],
            ..Default::default()
        }
    }

    #[test]
    fn opacities_move_and_colours_stay() {
        let mut view = transfer();
        let before = view.function().unwrap();
        move_opacity(&mut view, 1, 0.75, 0.1);
        let after = view.function().unwrap();
        for i in 0..=20 {
            let u = i as f32 / 20.0;
            assert!((after.sample(u)[0] - before.sample(u)[0]).abs() < 1e-6, "{u}");
        }
        assert_eq!(after.sample(0.75)[3], 0.1);
        assert!((view.points[1].rgb[0] - 0.6).abs() < 1e-6, "the points say the same colours");
    }

    #[test]
    fn nodes_meet_their_neighbours_but_never_pass_them() {
        let mut view = transfer();
        move_opacity(&mut view, 1, 9.0, 2.0);
        assert_eq!((view.points[1].u, view.points[1].opacity), (1.0, 1.0));
        move_opacity(&mut view, 0, -1.0, -1.0);
        move_colour(&mut view, 1, -3.0);
        assert_eq!(colour_nodes(&view).unwrap()[1].u, 0.0);
        assert!(view.function().is_ok());
    }

    #[test]
    fn a_new_node_of_colour_changes_nothing_until_it_is_painted() {
        let mut view = transfer();
        let before = view.function().unwrap();
        assert_eq!(add_colour(&mut view, 0.25), Some(1));
        assert!((view.function().unwrap().sample(0.3)[0] - before.sample(0.3)[0]).abs() < 1e-6);
        paint_colour(&mut view, 1, [1.0, 0.0, 0.0]);
        assert_eq!(view.function().unwrap().sample(0.25)[..3], [1.0, 0.0, 0.0]);
        assert_eq!(view.points.len(), 3);
        remove_colour(&mut view, 1);
        assert!((view.function().unwrap().sample(0.3)[0] - before.sample(0.3)[0]).abs() < 1e-6);
    }

    #[test]
    fn a_map_changes_colours_only_and_is_reversed_for_itself() {
        let mut view = transfer();
        choose_map(&mut view, ColourMap::by_name("viridis").unwrap());
        let of = |view: &TransferView, u| view.function().unwrap().sample(u);
        let [low, high] = [of(&view, 0.0), of(&view, 1.0)];
        assert_eq!((low[3], high[3]), (0.0, 1.0));
        assert_eq!(add_colour(&mut view, 0.5), None, "a named map has no nodes");
        reverse_colours(&mut view);
        assert_eq!(of(&view, 0.0), [high[0], high[1], high[2], 0.0]);
        reverse_opacities(&mut view);
        assert_eq!(of(&view, 0.0), high);
        free_colours(&mut view);
        assert_eq!(colour_nodes(&view).unwrap().len(), NODES as usize);
        assert!((of(&view, 0.0)[0] - high[0]).abs() < 1e-6);
    }

    #[test]
    fn the_last_nodes_stay() {
        let mut view = transfer();
        for _ in 0..9 {
            remove_opacity(&mut view, 0);
            remove_colour(&mut view, 0);
        }
        assert_eq!((view.points.len(), colour_nodes(&view).unwrap().len()), (1, 1));
    }
}
