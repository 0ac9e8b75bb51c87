//! `--layers`: what an EXR holds beside the colour of its pixels.

use renderer::BandLayers;

/// A value for each pixel. In the order of their channels, which is ascending.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, clap::ValueEnum)]
pub enum Layer {
    /// How deep lies what is seen: the mean view depth at which the pixel's opacity arises, of full sampling,
    /// in the run's unit of length along the camera's axis; infinite where nothing is seen. As channel Z, the
    /// name by which compositing programs know it. Takes a pass of full sampling more
    Depth,
    /// What the analysis charged to the pixel's ray: no channel of its colour is farther from full sampling,
    /// but for rounding. As channel predicted_error
    PredictedError,
}

impl Layer {
    /// The name of its channel.
    pub fn channel(self) -> &'static str {
        match self {
            Layer::Depth => "Z",
            Layer::PredictedError => "predicted_error",
        }
    }

    /// Names of the channels of `layers`, in ascending order, each once.
    pub fn channels(layers: &[Layer]) -> Vec<&'static str> {
        let mut layers = layers.to_vec();
        layers.sort();
        layers.dedup();
        layers.into_iter().map(Layer::channel).collect()
    }
}

/// What a renderer is asked for to have `layers`.
pub fn asked(layers: &[Layer]) -> BandLayers {
    BandLayers { charges: layers.contains(&Layer::PredictedError), depths: layers.contains(&Layer::Depth) }
}

/// The values of layers, in the order of their channels.
pub fn values<'a>(depths: &'a Option<Vec<f32>>, charged: &'a Option<Vec<f32>>) -> Vec<&'a [f32]> {
    [depths, charged].into_iter().flatten().map(Vec::as_slice).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn channels_ascend_in_whatever_order_layers_are_asked_for() {
        let asked = [Layer::PredictedError, Layer::Depth, Layer::PredictedError];
        let channels = Layer::channels(&asked);
        assert_eq!(channels, ["Z", "predicted_error"]);
        assert!(channels.is_sorted(), "as an EXR wants them, behind R");
    }
}
