// Second pass: the light that each pixel shows, as the renderer's integrator "direct" has it, but
// with hard shadows only. Follows shapes.glsl.
uniform usampler2D seen_by;    // the first pass
uniform usampler2D shade_list; // cells of the suns' grids, then bodies in them, see shadows.js
#if SUNS > 0
uniform vec4 sun_toward[SUNS];      // right, up, forward, fourth
uniform vec3 sun_irradiance[SUNS];  // on a facing surface
uniform mat3 sun_map[SUNS];         // from the slice to the sun's grid [cells]
uniform vec3 sun_origin[SUNS];
uniform ivec3 sun_size[SUNS];    // of its grid [cells]
uniform ivec3 sun_places[SUNS];  // in shade_list: first cell, first large body, large bodies
#endif
#if LAMPS > 0
uniform vec4 lamp_place[LAMPS];  // right, up, forward, fourth [m]
uniform vec4 lamp_power[LAMPS];  // a point's flux or a sphere's radiance; the sphere's radius [m]
#endif
#ifdef TINTS
uniform sampler2D tints;  // a texel a body
#endif
uniform vec3 sky;
uniform float gain;
uniform uint chosen;  // number of the chosen body + 1, or 0

out vec4 color;

const float kPi = 3.14159265358979;
const float kLambert = 3.0 / (4.0 * kPi);  // reflects an albedo of 1 in four dimensions
const float kPatternDepth = 1e-4;          // patterns are read below the surface, see shading.cpp
const vec3 kChosen = vec3(1.0, 0.32, 0.0);

#if defined(SHADOWS) && SUNS > 0
int shade_entry(int i) { return int(texelFetch(shade_list, place(i), 0).x); }

bool stops(uint number, uint own, vec3 point, vec4 toward) {
    Body body = body_at(number);
    Form form = form_at(body.form);
    vec4 direction = to_body(body, toward), start = to_body(body, point);
    vec2 part = part_in(form, body.origin + start, direction);
    bool is_stopped = part.x <= part.y && part.y > 0.0 && part.x < limit;
#ifdef SHAPE_PLANE
    if (form.kind == kPlane) {
        vec4 normal = form_texel(form.first);
        is_stopped = dot(normal, start) + body.clearance < 0.0 || dot(normal, direction) < 0.0;
    }
#endif
    return is_stopped && number + 1u != own;
}

// Bodies cast shadows in four dimensions, those outside the slice too. Along the sun's light only
// the three directions across it matter: a grid in them says which bodies may stand in the way.
bool in_shadow(int sun, vec3 point, uint own) {
    ivec3 size = sun_size[sun], places = sun_places[sun];
    ivec3 cell = ivec3(floor(sun_map[sun] * point + sun_origin[sun]));
    int first = 0, last = 0;
    if (all(greaterThanEqual(cell, ivec3(0))) && all(lessThan(cell, size))) {
        int at = places.x + cell.x + size.x * (cell.y + size.y * cell.z);
        first = shade_entry(at);
        last = shade_entry(at + 1);
    }
    // Large bodies first, which are in no cell.
    for (int i = 0; i < places.z + last - first; ++i) {
        int at = i < places.z ? places.y + i : first + i - places.z;
        if (stops(uint(shade_entry(at)), own, point, sun_toward[sun])) return true;
    }
    return false;
}
#endif

#if defined(PATTERN_CELLS) || defined(PATTERN_W) || defined(TINTS)
// The hue turned by a part of the colour circle, see tint.cpp.
vec3 turned_hue(vec3 rgb, float turn) {
    float most = max(rgb.r, max(rgb.g, rgb.b)), least = min(rgb.r, min(rgb.g, rgb.b));
    float range = most - least;
    if (range <= 0.0) return rgb;
    float hue = most == rgb.r ? (rgb.g - rgb.b) / range
              : most == rgb.g ? 2.0 + (rgb.b - rgb.r) / range : 4.0 + (rgb.r - rgb.g) / range;
    vec3 at = hue + 6.0 * turn - vec3(0, 2, 4), away = abs(at - 6.0 * round(at / 6.0));
    return least + range * clamp(2.0 - away, 0.0, 1.0);
}
#endif

// Patterns follow pattern.cpp.
#ifdef PATTERN_NOISE
float random_at(uvec4 corner) {
    uint bits = 0u;
    for (int i = 0; i < 4; ++i) {
        bits = (bits + corner[i]) * 0x9e3779b1u;
        bits ^= bits >> 15;
        bits *= 0x85ebca77u;
        bits ^= bits >> 13;
    }
    return float(bits >> 8) / 16777216.0;
}

float smooth_random(vec4 at) {
    vec4 cell = floor(at), t = at - cell, fade = t * t * t * (t * (6.0 * t - 15.0) + 10.0);
    uvec4 corner = uvec4(ivec4(cell));
    float sum = 0.0;
    for (uint i = 0u; i < 16u; ++i) {
        uvec4 up = uvec4(i, i >> 1, i >> 2, i >> 3) & 1u;
        vec4 share = mix(1.0 - fade, fade, vec4(up));
        sum += share.x * share.y * share.z * share.w * random_at(corner + up);
    }
    return sum;
}

float noise_at(vec4 at) {
    float sum = smooth_random(at) + 0.5 * smooth_random(2.0 * at) + 0.25 * smooth_random(4.0 * at);
    return smoothstep(0.25, 0.75, sum / 1.75);
}
#endif

#ifdef PATTERN_GRID
bool is_on_grid(vec4 point, vec4 normal, float size, float width) {
    vec4 off = abs(point - size * round(point / size));
    return any(lessThan(off, 0.5 * width * sqrt(max(vec4(0), 1.0 - normal * normal))));
}
#endif

#if defined(PATTERN_EDGES) || defined(PATTERN_CELLS)
// The number of a box's or polytope's cell whose normal it is, or -1.
int cell_number(Form form, vec4 normal) {
    int cell = -1;
    float most = -kFar;
#ifdef SHAPE_BOX
    if (form.kind == kBox)
        for (int axis = 0; axis < 4; ++axis)
            if (abs(normal[axis]) > most) most = abs(normal[axis]), cell = 2 * axis + int(normal[axis] > 0.0);
#endif
#ifdef SHAPE_HULL
    if (form.kind == kHull)
        for (int i = 0; i < form.count; ++i) {
            float along = dot(normalize(form_texel(form.first + i)), normal);
            if (along > most) most = along, cell = i;
        }
#endif
    return cell;
}
#endif

#ifdef PATTERN_EDGES
float distance_to_edge(Form form, vec4 point, vec4 normal) {
    int own = cell_number(form, normal);
    float nearest = kFar;
#ifdef SHAPE_BOX
    if (form.kind == kBox) {
        vec4 away = form_texel(form.first) - abs(point);
        for (int axis = 0; axis < 4; ++axis)
            if (axis != own / 2) nearest = min(nearest, away[axis]);
    }
#endif
#ifdef SHAPE_HULL
    if (form.kind == kHull) {
        vec4 n = normalize(form_texel(form.first + own));
        for (int i = 0; i < form.count; ++i) {
            vec4 plane = form_texel(form.first + i);
            // The plane's slope along the own cell; of that itself, and of one parallel to it, 0.
            float slope = length(plane - dot(n, plane) * n);
            if (slope > 1e-3 * length(plane)) nearest = min(nearest, (1.0 - dot(plane, point)) / slope);
        }
    }
#endif
    return nearest;
}
#endif

#ifdef PATTERN_W
uniform vec4 axes_w;  // the world's w of right, up, forward, fourth
uniform float camera_w;
uniform vec3 side_colors[2];  // at negative and positive w
#endif

// The albedo of a material; `point` is in the slice, `local` in the body's frame.
vec3 albedo_at(Body body, Form form, vec4 local, vec4 normal, vec3 point) {
    int at = 4 * form.material;
    vec3 albedo = texelFetch(materials, place(at), 0).rgb;
#ifdef PATTERNS
    vec4 other = texelFetch(materials, place(at + 1), 0), more = texelFetch(materials, place(at + 3), 0);
    float size = texelFetch(materials, place(at + 2), 0).w;
    vec4 below = local - kPatternDepth * size * normal, cell = floor(below / size + 0.5);
#ifdef PATTERN_CHECKER
    if (other.w == 1.0 && mod(cell.x + cell.y + cell.z + cell.w, 2.0) != 0.0) albedo = other.rgb;
#endif
#ifdef PATTERN_STRIPES
    if (other.w == 2.0 && mod(cell.x, 2.0) != 0.0) albedo = other.rgb;
#endif
#ifdef PATTERN_NOISE
    if (other.w == 3.0) albedo = mix(albedo, other.rgb, noise_at(below / size));
#endif
#ifdef PATTERN_GRID
    if (other.w == 4.0 && is_on_grid(local, normal, size, more.x)) albedo = other.rgb;
#endif
#ifdef PATTERN_EDGES
    if (other.w == 5.0 && distance_to_edge(form, local, normal) < 0.5 * more.x) albedo = other.rgb;
#endif
#ifdef PATTERN_CELLS
    if (other.w == 6.0) {
        int number = cell_number(form, normal);
        if (number >= 0) albedo *= turned_hue(vec3(1.0, 0.25, 0.2), fract(0.6180339887498949 * float(number)));
    }
#endif
#ifdef PATTERN_W
    if (other.w == 7.0) {
        vec4 centre = -vec4(dot(body.right, body.origin), dot(body.up, body.origin),
                            dot(body.forward, body.origin), dot(body.fourth, body.origin));
        float w = camera_w + dot(axes_w, more.y == 1.0 ? centre : vec4(point, body.shift));
        float part = clamp(w / size, -1.0, 1.0);
        albedo *= mix(vec3(1), side_colors[part > 0.0 ? 1 : 0], abs(part));
    }
#endif
#endif
    return albedo;
}

#if LAMPS > 0
// What a lamp brings to a surface; nothing shades it here.
vec3 from_lamp(int lamp, vec4 point, vec4 normal) {
    vec4 way = lamp_place[lamp] - point;
    float away = length(way), radius = lamp_power[lamp].w;
    float cosine = max(0.0, dot(normal, way) / away), sine = min(1.0, radius / away);
    float cube = radius == 0.0 ? 1.0 / (2.0 * kPi * kPi * away * away * away)
                               : 4.0 / 3.0 * kPi * sine * sine * sine;
    return lamp_power[lamp].rgb * cosine * cube;
}
#endif

#if LAMPS > 0
// Where a view ray meets a lamp that is a ball, or kFar.
float lamp_distance(int lamp, vec3 direction) {
    vec2 part = in_ball(-lamp_place[lamp], vec4(direction, 0), lamp_power[lamp].w);
    return part.x <= part.y && part.y > 0.0 ? max(0.0, part.x) : kFar;
}
#endif

vec3 light_of(uint number, float t, vec3 direction) {
    Body body = body_at(number);
    Form form = form_at(body.form);
    vec3 point = t * direction;
    vec4 local = body.origin + body.shift * body.fourth + to_body(body, point);
    vec4 out_of = normal_at(form, local);
    vec4 normal = vec4(dot(out_of, body.right), dot(out_of, body.up), dot(out_of, body.forward),
                       dot(out_of, body.fourth));

    vec4 glow = texelFetch(materials, place(4 * form.material + 2), 0);
    vec3 albedo = albedo_at(body, form, local, out_of, point);
#ifdef TINTS
    vec4 tint = texelFetch(tints, place(int(number)), 0);
    albedo = tint.rgb * turned_hue(albedo, tint.a);
#endif
    vec3 irradiance = vec3(0);
#if SUNS > 0
    for (int i = 0; i < SUNS; ++i) {
        float cosine = dot(normal, sun_toward[i]);
#ifdef SHADOWS
        if (cosine > 0.0 && in_shadow(i, point, number + 1u)) cosine = 0.0;
#endif
        irradiance += max(0.0, cosine) * sun_irradiance[i];
    }
#endif
#if LAMPS > 0
    for (int i = 0; i < LAMPS; ++i) irradiance += from_lamp(i, vec4(point, body.shift), normal);
#endif
    return glow.rgb + albedo * (sky + kLambert * irradiance);
}

#ifdef GHOSTS
uniform vec3 ghost_colors[2];  // on the negative and the positive side

// A ghost's light does not depend on the scene's, see ghosts.cpp.
vec3 ghost_light(Body body, float t, vec3 direction) {
    vec4 local = body.origin + body.shift * body.fourth + to_body(body, t * direction);
    vec4 normal = normal_at(form_at(body.form), local);
    vec3 seen = vec3(dot(normal, body.right), dot(normal, body.up), dot(normal, body.forward));
    float facing = min(1.0, abs(dot(seen, direction)) / max(1e-6, length(seen)));
    return mix(0.4, 1.0, facing) * ghost_colors[body.shift > 0.0 ? 1 : 0];
}

// The four nearest ghosts before what is solid, one over the other.
vec3 with_ghosts(vec3 behind, uvec4 tile, vec3 direction, float solid) {
    vec4 t = vec4(kFar);
    uvec4 who = uvec4(0u);
    for (uint i = tile.z; i < tile.z + tile.w; ++i) {
        uvec2 entry = texelFetch(list, place(int(i)), 0).xy;
        if (uintBitsToFloat(entry.y) > min(solid, t.w)) break;
        Body body = body_at(entry.x);
        float own = hit_distance(body, form_at(body.form), direction);
        if (own >= solid || own == 0.0) continue;
        // Sorted into the four.
        if (own < t.x) t = vec4(own, t.xyz), who = uvec4(entry.x, who.xyz);
        else if (own < t.y) t = vec4(t.x, own, t.yz), who = uvec4(who.x, entry.x, who.yz);
        else if (own < t.z) t = vec4(t.xy, own, t.z), who = uvec4(who.xy, entry.x, who.z);
        else if (own < t.w) t.w = own, who.w = entry.x;
    }
    for (int i = 3; i >= 0; --i) {
        if (t[i] == kFar) continue;
        Body body = body_at(who[i]);
        behind = mix(behind, ghost_light(body, t[i], direction), body.opacity);
    }
    return behind;
}
#endif

vec3 srgb(vec3 v) {
    v = clamp(v, 0.0, 1.0);
    return mix(12.92 * v, 1.055 * pow(v, vec3(1.0 / 2.4)) - 0.055, step(0.0031308, v));
}

#ifdef OUTLINE
bool on_outline(ivec2 at, uint who) {
    ivec2 last = textureSize(seen_by, 0) - 1;
    for (int i = 0; i < 25; ++i) {
        ivec2 beside = clamp(at + ivec2(i % 5 - 2, i / 5 - 2), ivec2(0), last);
        if (texelFetch(seen_by, beside, 0).x == chosen) return who != chosen;
    }
    return false;
}
#endif

void main() {
    ivec2 at = ivec2(gl_FragCoord.xy);
    vec3 direction = view_direction(gl_FragCoord.xy);
    uvec2 seen = texelFetch(seen_by, at, 0).xy;
    float t = uintBitsToFloat(seen.y);
    vec3 light = sky;
    if (seen.x != 0u) light = light_of(seen.x - 1u, t, direction);
    if (seen.x == 0u) t = kFar;
#if LAMPS > 0
    for (int i = 0; i < LAMPS; ++i) {
        float own = lamp_power[i].w > 0.0 ? lamp_distance(i, direction) : kFar;
        if (own < t) t = own, light = lamp_power[i].rgb;
    }
#endif
    light = min(gain * light, 1.0);
#ifdef GHOSTS
    uvec4 tile = texelFetch(tiles, at / tile_size, 0);
    light = with_ghosts(light, tile, direction, t);
#endif
    color = vec4(srgb(light), 1);
#ifdef OUTLINE
    if (on_outline(at, seen.x)) color.rgb = kChosen;
#endif
}
