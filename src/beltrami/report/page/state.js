// What the reader has chosen.

export const state = {
    map: null,          // one of mesh.js' maps
    overlay: "none",    // or "checker", "circles", "image"
    shares: "area",     // of the histogram
    top: 1,             // |μ| of the last colour
    blend: 0,           // of the source's figure: 0 the source, 1 the image
    edges: false, trajectories: false, across: false, ellipses: false, points: false, outline: true,
    picked: -1,         // a triangle
};
