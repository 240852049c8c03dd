/// The formulas whose kernels are measured, by the names of their surfaces.
const MEASURED: [&str; 6] = ["paper", "tanglecube", "heart", "barth", "gyroid", "metaballs"];
