// What both passes know: the bodies, and where a ray meets them, in closed form. A ray is seen from
// the body: its start `p` and direction `d` in the body's own four-dimensional frame.
precision highp float;
precision highp int;
precision highp usampler2D;
precision highp sampler2D;

// renderer.js puts definitions before this text: SUNS and LAMPS count the scene's; SHAPE_... are
// those of its shapes; SHADOWS, GHOSTS and OUTLINE what is shown. What is not there costs nothing,
// above all where software runs both sides of every branch.

uniform sampler2D bodies;     // six texels a body, see bodies.js
uniform sampler2D forms;      // two texels a type, then what they point to, see forms.js
uniform sampler2D materials;  // four texels a material
uniform usampler2D tiles;     // by tile: first solid, solids, first ghost, ghosts in `list`
uniform usampler2D list;      // bodies: number, and how near they may be as bits of a float
uniform int tile_size;        // [pixels]
uniform vec2 film_centre;     // [pixels, from the bottom left]
uniform float pixel;          // side of a pixel at distance 1
uniform float limit;          // what is farther along a ray is not met [m]

const float kFar = 3e38;
const vec2 kNowhere = vec2(kFar, -kFar);
const vec2 kEverywhere = vec2(-kFar, kFar);

const int kSphere = 0, kCapsule = 1, kBox = 2, kPlane = 3, kHull = 4, kProduct = 5;

struct Body {
    vec4 right, up, forward, fourth;  // the camera's axes, as the body sees them
    vec4 origin;                      // the camera's place, likewise [m]
    int form;
    float shift;      // of a ghost: how far along `fourth` its slice is [m]
    float clearance;  // of a plane: its distance from the camera [m]
    float opacity;    // of a ghost
};

struct Form {
    int kind;
    float bound;  // radius of the ball that holds it [m]
    int first, count;
    int material;
};

ivec2 place(int i) { return ivec2(i & 2047, i >> 11); }
vec4 form_texel(int i) { return texelFetch(forms, place(i), 0); }

Body body_at(uint number) {
    ivec2 at = ivec2(int(number & 255u) * 6, int(number >> 8));
    Body b;
    b.right = texelFetch(bodies, at, 0);
    b.up = texelFetch(bodies, at + ivec2(1, 0), 0);
    b.forward = texelFetch(bodies, at + ivec2(2, 0), 0);
    b.fourth = texelFetch(bodies, at + ivec2(3, 0), 0);
    b.origin = texelFetch(bodies, at + ivec2(4, 0), 0);
    vec4 more = texelFetch(bodies, at + ivec2(5, 0), 0);
    b.form = int(more.x);
    b.shift = more.y;
    b.clearance = more.z;
    b.opacity = more.w;
    return b;
}

Form form_at(int number) {
    vec4 a = form_texel(2 * number), b = form_texel(2 * number + 1);
    return Form(int(a.x), a.y, int(a.z), int(a.w), int(b.x));
}

// A direction or a point of the slice, which has no part along the fourth axis, as a body sees it.
vec4 to_body(Body b, vec3 v) { return v.x * b.right + v.y * b.up + v.z * b.forward; }
vec4 to_body(Body b, vec4 v) { return to_body(b, v.xyz) + v.w * b.fourth; }

// The unit direction of the view ray through a point of the film: right, up, forward.
vec3 view_direction(vec2 film) { return normalize(vec3((film - film_centre) * pixel, 1.0)); }

vec2 both(vec2 a, vec2 b) { return vec2(max(a.x, b.x), min(a.y, b.y)); }
// Of two parts of a line with none but line between them; either may be empty.
vec2 either(vec2 a, vec2 b) {
    if (a.x > a.y) return b;
    if (b.x > b.y) return a;
    return vec2(min(a.x, b.x), max(a.y, b.y));
}

vec2 in_ball(vec4 p, vec4 d, float radius) {
    float a = dot(d, d);
    if (a < 1e-12) return dot(p, p) <= radius * radius ? kEverywhere : kNowhere;
    float middle = -dot(p, d) / a;
    vec4 nearest = p + middle * d;
    float h = radius * radius - dot(nearest, nearest);
    if (h < 0.0) return kNowhere;
    float half_chord = sqrt(h / a);
    return vec2(middle - half_chord, middle + half_chord);
}

// The points with p along an axis within `half_width` of 0.
vec2 in_slab(float p, float d, float half_width) {
    if (abs(d) < 1e-9) return abs(p) <= half_width ? kEverywhere : kNowhere;
    float a = (-half_width - p) / d, b = (half_width - p) / d;
    return vec2(min(a, b), max(a, b));
}

vec2 in_capsule(vec4 p, vec4 d, float radius, float half_height) {
    const vec4 across = vec4(1, 0, 1, 1);
    vec4 end = vec4(0, half_height, 0, 0);
    vec2 wall = both(in_ball(p * across, d * across, radius), in_slab(p.y, d.y, half_height));
    return either(wall, either(in_ball(p - end, d, radius), in_ball(p + end, d, radius)));
}

vec2 in_box(vec4 p, vec4 d, vec4 size) {
    vec2 part = both(in_slab(p.x, d.x, size.x), in_slab(p.y, d.y, size.y));
    return both(part, both(in_slab(p.z, d.z, size.z), in_slab(p.w, d.w, size.w)));
}

// Of half-spaces n . x <= 1.
vec2 in_hull(vec4 p, vec4 d, int first, int count) {
    vec2 part = kEverywhere;
    for (int i = first; i < first + count; ++i) {
        vec4 n = form_texel(i);
        float slope = dot(n, d), gap = 1.0 - dot(n, p);
        if (abs(slope) < 1e-9) {
            if (gap < 0.0) return kNowhere;
        } else if (slope > 0.0) {
            part.y = min(part.y, gap / slope);
        } else {
            part.x = max(part.x, gap / slope);
        }
        if (part.x > part.y) return kNowhere;
    }
    return part;
}

vec2 in_product(vec4 p, vec4 d, int first, int count) {
    vec2 part = kEverywhere;
    for (int i = 0; i < count; ++i) {
        vec4 axes = form_texel(first + 2 * i);
        part = both(part, in_ball(p * axes, d * axes, form_texel(first + 2 * i + 1).x));
    }
    return part;
}

// Which part of the line from p along d (unit) is in a body: (enter, leave). All is computed from
// the line's point nearest to the body's centre, so that a far body loses no digits.
vec2 part_in(Form form, vec4 p, vec4 d) {
    float middle = -dot(p, d);
    p += middle * d;
    vec2 part = in_ball(p, d, form.bound);
    if (part.x > part.y) return kNowhere;
#ifdef SHAPE_CAPSULE
    if (form.kind == kCapsule) {
        vec4 sizes = form_texel(form.first);
        part = in_capsule(p, d, sizes.x, sizes.y);
    }
#endif
#ifdef SHAPE_BOX
    if (form.kind == kBox) part = in_box(p, d, form_texel(form.first));
#endif
#ifdef SHAPE_HULL
    if (form.kind == kHull) part = in_hull(p, d, form.first, form.count);
#endif
#ifdef SHAPE_PRODUCT
    if (form.kind == kProduct) part = in_product(p, d, form.first, form.count);
#endif
    return part.x <= part.y ? part + middle : kNowhere;
}

// Where a view ray meets a body, or kFar; 0 from inside it.
float hit_distance(Body body, Form form, vec3 direction) {
    float t = kFar;
    vec4 d = to_body(body, direction);
    vec2 part = part_in(form, body.origin + body.shift * body.fourth, d);
    if (part.x <= part.y && part.y >= 0.0) t = max(0.0, part.x);
#ifdef SHAPE_PLANE
    if (form.kind == kPlane) {
        float approach = -dot(form_texel(form.first), d);
        t = approach > 0.0 ? body.clearance / approach : kFar;
        if (body.clearance <= 0.0) t = 0.0;
    }
#endif
    return t;
}

// Out of a body at a point of its surface, as the body sees it; of any length.
vec4 box_normal(vec4 p, vec4 size) {
    vec4 depth = abs(p) - size;
    float most = max(max(depth.x, depth.y), max(depth.z, depth.w));
    return sign(p) * vec4(greaterThanEqual(depth, vec4(most)));
}

vec4 hull_normal(vec4 p, int first, int count) {
    float most = -kFar;
    vec4 normal = vec4(0, 1, 0, 0);
    for (int i = first; i < first + count; ++i) {
        vec4 n = form_texel(i);
        float depth = (dot(n, p) - 1.0) * inversesqrt(dot(n, n));
        if (depth > most) most = depth, normal = n;
    }
    return normal;
}

vec4 product_normal(vec4 p, int first, int count) {
    float most = -kFar;
    vec4 normal = vec4(0, 1, 0, 0);
    for (int i = 0; i < count; ++i) {
        vec4 part = p * form_texel(first + 2 * i);
        float depth = length(part) - form_texel(first + 2 * i + 1).x;
        if (depth > most) most = depth, normal = part;
    }
    return normal;
}

vec4 normal_at(Form form, vec4 p) {
    vec4 normal = p;
#ifdef SHAPE_PLANE
    if (form.kind == kPlane) normal = form_texel(form.first);
#endif
#ifdef SHAPE_CAPSULE
    if (form.kind == kCapsule) {
        float half_height = form_texel(form.first).y;
        normal.y -= clamp(p.y, -half_height, half_height);
    }
#endif
#ifdef SHAPE_BOX
    if (form.kind == kBox) normal = box_normal(p, form_texel(form.first));
#endif
#ifdef SHAPE_HULL
    if (form.kind == kHull) normal = hull_normal(p, form.first, form.count);
#endif
#ifdef SHAPE_PRODUCT
    if (form.kind == kProduct) normal = product_normal(p, form.first, form.count);
#endif
    return normalize(normal);
}
