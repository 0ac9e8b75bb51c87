//! Compares the layout of a Rust struct with the struct of the same name in a shader.

/// Offsets and size that `naga` computes for the WGSL struct `name` of `source`.
fn wgsl_layout(source: &str, name: &str) -> (Vec<(String, usize)>, usize) {
    let module = naga::front::wgsl::parse_str(source).expect("the shader parses");
    let (_, ty) = module
        .types
        .iter()
        .find(|(_, ty)| ty.name.as_deref() == Some(name))
        .unwrap_or_else(|| panic!("no struct {name} in the shader"));
    let naga::TypeInner::Struct { members, span } = &ty.inner else { panic!("{name} is no struct") };
    let offset =
        |member: &naga::StructMember| (member.name.clone().unwrap_or_default(), member.offset as usize);
    (members.iter().map(offset).collect(), *span as usize)
}

/// Fails unless `fields`, in this order, are the members of the WGSL struct at the same offsets, and
/// the sizes are equal.
pub(crate) fn check(source: &str, name: &str, fields: &[(&str, usize)], size: usize) {
    let (members, span) = wgsl_layout(source, name);
    let fields: Vec<_> = fields.iter().map(|(field, offset)| ((*field).to_owned(), *offset)).collect();
    assert_eq!(members, fields, "offsets of {name}");
    assert_eq!(span, size, "size of {name}");
}

/// `check_layout!(source, wgsl name, Rust type, field, field, ...)`.
macro_rules! check_layout {
    ($source:expr, $name:literal, $type:ty, $($field:ident),+) => {
        $crate::stages::layout::check(
            $source,
            $name,
            &[$((stringify!($field), std::mem::offset_of!($type, $field))),+],
            size_of::<$type>(),
        )
    };
}
pub(crate) use check_layout;

#[test]
#[should_panic(expected = "offsets of Pair")]
fn a_wrong_offset_is_noticed() {
    #[repr(C)]
    struct Pair {
        a: f32,
        b: [f32; 3],
    }
    let source = "struct Pair { a: f32, b: vec3<f32> } @group(0) @binding(0) var<uniform> pair: Pair;";
    check_layout!(source, "Pair", Pair, a, b);
}
