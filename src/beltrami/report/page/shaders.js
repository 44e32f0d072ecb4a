// What runs on the graphics card. Everything drawn has a place on the source and one in the image; `blend` leads from
// the one to the other.

const place = `
precision highp float;
uniform mat3 axes;      // right, up and towards the reader, as rows
uniform mat3 align;     // of the image, onto the source
uniform vec4 frame;     // scale and shift of right and up
uniform float blend;
vec3 between(vec3 here, vec3 there) { return mix(here, align * there, blend); }
vec4 seen(vec3 at, float lift) {
    vec3 turned = axes * at;
    return vec4(frame.xy * turned.xy + frame.zw, -0.5 * turned.z - lift, 1.0);
}`;

export const surface = {
    vertex: `${place}
in vec3 position, image;
in vec4 normal, imageNormal;
in float absMu;
uniform bool textureOnImage;
uniform vec3 light;
flat out float m;
out vec3 where;
out float lit;
void main() {
    m = absMu;
    where = textureOnImage ? image : position;
    lit = dot(normalize(mix(normal.xyz, align * imageNormal.xyz, blend) + 1e-9), light);
    gl_Position = seen(between(position, image), 0.0);
}`,
    fragment: `
precision highp float;
flat in float m;
in vec3 where;
in float lit;
uniform sampler2D palette, picture;
uniform float top, shaded;
uniform int overlay;     // 0 none, 1 checker, 2 circles, 3 picture
uniform bool spherical;
uniform vec2 pictureScale;
out vec4 colour;
const float CELL = 0.125, TURN = 6.283185307;
vec3 base() {
    if (m < 0.0) return vec3(154.0, 160.0, 168.0) / 255.0;  // undefined
    if (m > 1.0) return vec3(1.0, 0.0, 212.0 / 255.0);      // flipped
    return texture(palette, vec2((min(m / top, 1.0) * 255.0 + 0.5) / 256.0, 0.5)).rgb;
}
/// Of a surface in space longitude and latitude about its middle. The jump of the longitude is no gradient.
vec2 coordinates(out vec2 dx, out vec2 dy) {
    vec2 at = where.xy, other;
    if (spherical) {
        vec3 d = normalize(where);
        at = other = vec2(atan(d.y, d.x), asin(clamp(d.z, -1.0, 1.0))) * (2.0 / TURN);
        if (d.x < 0.0) other.x = at.x < 0.0 ? at.x + 2.0 : at.x;
    } else {
        other = at;
    }
    dx = dFdx(other);
    dy = dFdy(other);
    return at;
}
void main() {
    vec3 c = base();
    if (overlay > 0) {
        vec2 dx, dy, at = coordinates(dx, dy);
        if (overlay == 3) {
            vec2 s = pictureScale;
            vec3 shown = textureGrad(picture, 0.5 + 0.5 * at * s, 0.5 * dx * s, 0.5 * dy * s).rgb;
            c = m < 0.0 || m > 1.0 ? mix(c, shown, 0.3) : shown;
        } else {
            float cell = spherical ? 1.0 / 12.0 : CELL;
            at /= cell;
            float blur = 1e-6 + 0.70710678 * length(vec4(dx, dy)) / cell, mixed;
            vec2 part = fract(at);
            if (overlay == 2) {
                mixed = clamp(0.5 + (0.38 - length(part - 0.5)) / blur, 0.0, 1.0);
            } else {
                vec2 near = min(2.0 * min(part, 1.0 - part) / blur, 1.0);
                float odd = mod(floor(at.x) + floor(at.y), 2.0);
                mixed = 0.5 + (odd - 0.5) * near.x * near.y;
            }
            c = c * (overlay == 2 ? 1.0 - 0.36 * mixed : 0.76 - 0.14 * mixed) + 92.0 / 255.0 * mixed;
        }
    }
    float factor = gl_FrontFacing ? 0.66 + 0.4 * max(lit, 0.0) : 0.42 + 0.3 * max(-lit, 0.0);
    colour = vec4(min(c * mix(1.0, factor, shaded), 1.0), 1.0);
}`,
};

export const edges = {
    vertex: `${place}
in vec3 position, image;
void main() { gl_Position = seen(between(position, image), 1e-3); }`,
    fragment: `
precision highp float;
uniform float fade;
out vec4 colour;
void main() { colour = vec4(vec3(12.0, 14.0, 20.0) / 255.0, 1.0) * fade; }`,
};

/// A piece of a line, as wide as it is on the screen.
export const lines = {
    vertex: `${place}
in vec2 position;
in vec3 from, to, imageFrom, imageTo;
uniform vec2 pixel;      // of the screen, in its coordinates from −1 to 1
uniform float halfWidth; // in pixels
out float across;
void main() {
    vec4 a = seen(between(from, imageFrom), 6e-3), b = seen(between(to, imageTo), 6e-3);
    vec2 along = (b.xy - a.xy) / pixel;
    float size = length(along);
    along = size > 1e-6 ? along / size : vec2(1.0, 0.0);
    vec4 at = position.x < 0.5 ? a : b;
    across = position.y;
    at.xy += (vec2(-along.y, along.x) * position.y + along * 0.3 * (2.0 * position.x - 1.0)) * halfWidth * pixel;
    gl_Position = at;
}`,
    fragment: `
precision highp float;
in float across;
uniform vec3 core;
uniform float halfWidth;
out vec4 colour;
void main() {
    float away = abs(across) * halfWidth;
    float rim = clamp(halfWidth - away, 0.0, 1.0), inside = clamp(0.55 * halfWidth + 0.5 - away, 0.0, 1.0);
    colour = vec4(mix(vec3(0.05, 0.06, 0.09), core, inside), 1.0) * rim * mix(0.65, 1.0, inside);
}`,
};

export const ellipses = {
    vertex: `${place}
in vec2 position;
in vec3 centre, first, second, imageCentre, imageFirst, imageSecond;
out vec2 at;
void main() {
    at = 1.15 * position;
    vec3 here = centre + at.x * first + at.y * second, there = imageCentre + at.x * imageFirst + at.y * imageSecond;
    gl_Position = seen(between(here, there), 8e-3);
}`,
    fragment: `
precision highp float;
in vec2 at;
out vec4 colour;
void main() {
    float away = length(at), soft = fwidth(away) + 1e-6;
    float inside = clamp((1.0 - away) / soft + 0.5, 0.0, 1.0);
    float rim = clamp((away - 0.8) / soft + 0.5, 0.0, 1.0);
    colour = vec4(mix(vec3(1.0), vec3(0.05, 0.06, 0.09), rim), 1.0) * inside * mix(0.5, 0.95, rim);
}`,
};

/// Zeros: discs, with their order where it is above 1; poles: squares.
export const points = {
    vertex: `${place}
in vec2 position;
in vec3 centre, imageCentre;
in float order;
uniform vec2 pixel;
uniform float halfWidth;
out vec2 at;
flat out float kind;
void main() {
    at = position;
    kind = order;
    vec4 middle = seen(between(centre, imageCentre), 2e-2);
    gl_Position = middle + vec4(position * pixel * halfWidth * (order > 1.0 ? 1.6 : 1.0), 0.0, 0.0);
}`,
    fragment: `
precision highp float;
in vec2 at;
flat in float kind;
uniform sampler2D glyphs;
out vec4 colour;
void main() {
    float away = kind < 0.0 ? max(abs(at.x), abs(at.y)) * 1.25 : length(at), soft = fwidth(away) + 1e-6;
    float inside = clamp((1.0 - away) / soft, 0.0, 1.0), core = clamp((0.68 - away) / soft + 0.5, 0.0, 1.0);
    vec3 filling = kind < 0.0 ? vec3(1.0, 0.62, 0.25) : vec3(1.0);
    if (kind > 1.0) {
        vec2 cell = clamp(0.5 + 0.62 * at, 0.0, 1.0);
        core *= 1.0 - texture(glyphs, vec2((min(kind, 10.0) - 2.0 + cell.x) / 9.0, cell.y)).a;
    }
    colour = vec4(mix(vec3(0.05, 0.06, 0.09), filling, core), 1.0) * inside;
}`,
};
