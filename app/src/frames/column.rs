//! One array of a frame, kept at the precision of its file.

/// A table of `len` rows by `components` columns, row after row.
#[derive(Clone, Debug, PartialEq)]
pub struct Column {
    components: usize,
    data: Numbers,
}

/// The numbers of a [`Column`], single or double precision as the file gave them.
#[derive(Clone, Debug, PartialEq)]
pub enum Numbers {
    F32(Vec<f32>),
    F64(Vec<f64>),
}

impl Numbers {
    pub fn len(&self) -> usize {
        match self {
            Numbers::F32(values) => values.len(),
            Numbers::F64(values) => values.len(),
        }
    }

    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }

    #[inline]
    fn get(&self, index: usize) -> f64 {
        match self {
            Numbers::F32(values) => f64::from(values[index]),
            Numbers::F64(values) => values[index],
        }
    }
}

impl From<Vec<f32>> for Numbers {
    fn from(values: Vec<f32>) -> Self {
        Numbers::F32(values)
    }
}

impl From<Vec<f64>> for Numbers {
    fn from(values: Vec<f64>) -> Self {
        Numbers::F64(values)
    }
}

impl Column {
    /// A column of rows of `components` numbers; `None` where the numbers do not fill whole rows.
    pub fn new(components: usize, data: impl Into<Numbers>) -> Option<Self> {
        let data = data.into();
        (components > 0 && data.len().is_multiple_of(components)).then_some(Column { components, data })
    }

    pub fn scalars(data: impl Into<Numbers>) -> Self {
        Column { components: 1, data: data.into() }
    }

    pub fn components(&self) -> usize {
        self.components
    }

    /// Number of rows.
    pub fn len(&self) -> usize {
        self.data.len() / self.components
    }

    pub fn is_empty(&self) -> bool {
        self.data.is_empty()
    }

    pub fn numbers(&self) -> &Numbers {
        &self.data
    }

    pub fn into_numbers(self) -> Numbers {
        self.data
    }

    /// The number in `row` and `component`; panics outside the table.
    #[inline]
    pub fn get(&self, row: usize, component: usize) -> f64 {
        debug_assert!(component < self.components);
        self.data.get(row * self.components + component)
    }

    /// The Euclidean length of a row: the value itself, sign included, where there is one component.
    #[inline]
    pub fn magnitude(&self, row: usize) -> f64 {
        match self.components {
            1 => self.get(row, 0),
            // hypot keeps the length of huge and tiny vectors finite.
            n => (0..n).fold(0.0, |length: f64, c| length.hypot(self.get(row, c))),
        }
    }

    /// Bytes that the numbers take.
    pub fn bytes(&self) -> usize {
        match &self.data {
            Numbers::F32(values) => size_of_val(values.as_slice()),
            Numbers::F64(values) => size_of_val(values.as_slice()),
        }
    }
}
