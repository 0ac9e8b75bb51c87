//! What the user has chosen for the program as a whole. Nothing here changes a picture.

use std::path::PathBuf;

use renderer::GpuOptions;
use serde::{Deserialize, Deserializer, Serialize};

use super::Kept;
use crate::places;
use crate::viewer::keys::keymap::{Binding, Keymap};
use crate::viewer::render_thread::budget::Budget;
use crate::viewer::theme::Appearance;

#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(default)]
pub struct Settings {
    /// Part of the name of the adapter that renders; the fastest one where it is absent, or where there
    /// is none of that name.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub adapter: Option<String>,
    /// Bytes of device memory, in MiB, that a picture may take; what suits the adapter where it
    /// is absent.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub device_memory_mib: Option<u32>,
    /// Bytes of frames, in MiB, that are kept beside the one in view.
    pub frame_cache_mib: u32,
    pub appearance: Appearance,
    /// What moving pictures may take.
    pub budget: Budget,
    /// Size of letters and controls, in times of the system's.
    pub scale: f32,
    /// Whether the start page is shown where no run is named.
    pub start_page: bool,
    #[serde(deserialize_with = "known")]
    pub keys: Vec<Binding>,
}

impl Settings {
    pub const FRAME_CACHE_MIB: std::ops::RangeInclusive<u32> = 64..=1 << 20;

    pub const SCALE: std::ops::RangeInclusive<f32> = 0.6..=2.5;

    pub fn keymap(&self) -> Keymap {
        Keymap::from_bindings(&self.keys)
    }

    /// Size of letters and controls, within what can be read and used.
    pub fn usable_scale(&self) -> f32 {
        let (least, most) = Self::SCALE.into_inner();
        if self.scale.is_finite() { self.scale.clamp(least, most) } else { 1.0 }
    }

    /// Bytes of frames that are kept beside the one in view.
    pub fn frame_cache(&self) -> usize {
        (self.frame_cache_mib as usize) << 20
    }

    /// The device that is asked for; what `given` says, from the command line, goes first.
    pub fn gpu(&self, given: &GpuOptions) -> GpuOptions {
        GpuOptions {
            preferred: self.adapter.clone(),
            memory: given.memory.or(self.device_memory_mib.map(|mib| u64::from(mib) << 20)),
            ..given.clone()
        }
    }
}

impl Default for Settings {
    fn default() -> Self {
        Settings {
            adapter: None,
            device_memory_mib: None,
            frame_cache_mib: 2048,
            appearance: Appearance::default(),
            budget: Budget::default(),
            scale: 1.0,
            start_page: true,
            keys: Vec::new(),
        }
    }
}

impl Kept for Settings {
    const FILE: &'static str = "settings.json";

    fn folder() -> Option<PathBuf> {
        places::config()
    }
}

/// Keys of the actions that there are: another version of the program may have had others.
fn known<'de, D: Deserializer<'de>>(deserializer: D) -> Result<Vec<Binding>, D::Error> {
    let bindings = Vec::<serde_json::Value>::deserialize(deserializer)?;
    Ok(bindings.into_iter().filter_map(|binding| serde_json::from_value(binding).ok()).collect())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn settings_of_another_version_are_understood() {
        let text = r#"{"frame_cache_mib": 512, "unheard_of": 1,
            "keys": [{"action": "time-travel", "keys": ["T"]}, {"action": "fly", "keys": ["G"]}]}"#;
        let settings: Settings = serde_json::from_str(text).unwrap();
        assert_eq!((settings.frame_cache(), settings.keys.len()), (512 << 20, 1));
        assert!(settings.start_page);
        assert_eq!(Settings { scale: 1e9, ..settings }.usable_scale(), 2.5);
    }

    #[test]
    fn the_command_line_goes_before_the_settings() {
        let settings =
            Settings { adapter: Some("card".into()), device_memory_mib: Some(100), ..Settings::default() };
        let given = GpuOptions { adapter: Some("other".into()), memory: Some(7), ..GpuOptions::default() };
        let gpu = settings.gpu(&given);
        assert_eq!((gpu.adapter.as_deref(), gpu.memory), (Some("other"), Some(7)));
        let gpu = settings.gpu(&GpuOptions::default());
        assert_eq!((gpu.adapter, gpu.preferred.as_deref()), (None, Some("card")));
        assert_eq!(gpu.memory, Some(100 << 20));
    }
}
