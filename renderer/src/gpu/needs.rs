//! What the pipelines need of an adapter, and which adapters have it.

use crate::error::GpuError;

/// Storage buffers of a shader.
pub(super) const STORAGE_BUFFERS: u32 = 17;
/// Invocations of a workgroup, and bytes that they share.
pub(super) const WORKGROUP_SIZE: u32 = 256;
pub(super) const WORKGROUP_BYTES: u32 = 16_384;

/// What an adapter of these `limits` lacks.
pub(super) fn lacking(limits: &wgpu::Limits) -> Option<String> {
    [
        ("storage buffers in a shader", limits.max_storage_buffers_per_shader_stage, STORAGE_BUFFERS),
        ("invocations in a workgroup", limits.max_compute_invocations_per_workgroup, WORKGROUP_SIZE),
        ("bytes in a workgroup", limits.max_compute_workgroup_storage_size, WORKGROUP_BYTES),
    ]
    .into_iter()
    .find(|(_, has, needed)| has < needed)
    .map(|(what, has, needed)| format!("it has {has} {what}, of which {needed} are needed"))
}

/// Which of `adapters` to take: the first one that lacks nothing, of those whose name holds `wanted`.
///
/// # Errors
/// Where there is none, why.
pub(super) fn choose(adapters: &[(String, wgpu::Limits)], wanted: Option<&str>) -> Result<usize, GpuError> {
    let wanted_lower = wanted.unwrap_or_default().to_lowercase();
    let mut weak = None;
    for (index, (name, limits)) in adapters.iter().enumerate() {
        if !name.to_lowercase().contains(&wanted_lower) {
            continue;
        }
        match lacking(limits) {
            None => return Ok(index),
            Some(what) => weak = weak.or(Some(GpuError::TooWeak { adapter: name.clone(), what })),
        }
    }
    Err(match (weak, wanted) {
        (Some(weak), _) => weak,
        (None, Some(wanted)) if !adapters.is_empty() => {
            let names: Vec<&str> = adapters.iter().map(|(name, _)| name.as_str()).collect();
            GpuError::NoSuchAdapter { wanted: wanted.to_owned(), found: names.join(", ") }
        }
        (None, _) => GpuError::NoAdapter,
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    /// What has just enough.
    fn enough() -> wgpu::Limits {
        wgpu::Limits {
            max_storage_buffers_per_shader_stage: STORAGE_BUFFERS,
            max_compute_invocations_per_workgroup: WORKGROUP_SIZE,
            max_compute_workgroup_storage_size: WORKGROUP_BYTES,
            ..wgpu::Limits::default()
        }
    }

    #[test]
    fn adapters_that_lack_something_are_passed_over() {
        let weak = wgpu::Limits { max_storage_buffers_per_shader_stage: 16, ..enough() };
        let all = [("Old Card".to_owned(), weak), ("New Card".to_owned(), enough())];
        assert_eq!(choose(&all, None).unwrap(), 1);
        assert_eq!(choose(&all, Some("card")).unwrap(), 1);
        let error = choose(&all, Some("old")).unwrap_err().to_string();
        assert!(error.contains("Old Card") && error.contains("16 storage buffers"), "{error}");
        assert!(matches!(choose(&all[..1], None), Err(GpuError::TooWeak { .. })));
        assert!(matches!(choose(&all, Some("none")), Err(GpuError::NoSuchAdapter { .. })));
        assert!(matches!(choose(&[], Some("none")), Err(GpuError::NoAdapter)));
    }

    #[test]
    fn every_limit_counts() {
        assert_eq!(lacking(&enough()), None);
        let fewer: [fn(&mut wgpu::Limits); 3] = [
            |limits| limits.max_storage_buffers_per_shader_stage -= 1,
            |limits| limits.max_compute_invocations_per_workgroup -= 1,
            |limits| limits.max_compute_workgroup_storage_size -= 1,
        ];
        for lower in fewer {
            let mut limits = enough();
            lower(&mut limits);
            assert!(lacking(&limits).is_some());
        }
    }
}
