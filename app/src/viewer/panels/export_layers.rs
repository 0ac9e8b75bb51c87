//! What exported EXR files hold beside the colour of their pixels.

use egui::Ui;

use crate::export::Layer;
use crate::viewer::widgets;

/// Layers that are ticked.
#[derive(Clone, Copy, Debug, Default)]
pub struct LayerChoice {
    depth: bool,
    predicted_error: bool,
}

impl LayerChoice {
    pub fn chosen(self) -> Vec<Layer> {
        let layers = [(Layer::Depth, self.depth), (Layer::PredictedError, self.predicted_error)];
        layers.into_iter().filter(|(_, chosen)| *chosen).map(|(layer, _)| layer).collect()
    }

    pub fn show(&mut self, ui: &mut Ui) {
        widgets::row(ui, "", |ui| {
            ui.checkbox(&mut self.depth, "Depth of each pixel").on_hover_text(
                "As channel Z: the mean distance along the camera's axis at which its opacity arises, infinite \
                 where nothing is seen. Takes longer: each picture is drawn once more in full",
            );
        });
        widgets::row(ui, "", |ui| {
            ui.checkbox(&mut self.predicted_error, "Predicted error of each pixel")
                .on_hover_text("As channel predicted_error: how far it may be from full sampling");
        });
    }
}
