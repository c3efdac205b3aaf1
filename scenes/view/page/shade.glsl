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

vec3 albedo_at(int material, vec4 local) {
    vec3 albedo = texelFetch(materials, place(3 * material), 0).rgb;
#ifdef PATTERNS
    vec4 other = texelFetch(materials, place(3 * material + 1), 0);
    float size = texelFetch(materials, place(3 * material + 2), 0).w;
    vec4 cell = floor(local / size + 0.5);
    float number = other.w == 1.0 ? cell.x + cell.y + cell.z + cell.w : cell.x;
    if (other.w != 0.0 && mod(number, 2.0) != 0.0) albedo = other.rgb;
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

struct Lit {
    vec3 light;
    float facing;  // cosine between the ray and the surface's normal in the slice
};

Lit light_of(uint number, float t, vec3 direction, bool casts) {
    Body body = body_at(number);
    Form form = form_at(body.form);
    vec3 point = t * direction;
    vec4 local = body.origin + body.shift * body.fourth + to_body(body, point);
    vec4 out_of = normal_at(form, local);
    vec4 normal = vec4(dot(out_of, body.right), dot(out_of, body.up), dot(out_of, body.forward),
                       dot(out_of, body.fourth));

    vec4 glow = texelFetch(materials, place(3 * form.material + 2), 0);
    vec3 albedo = albedo_at(form.material, local - kPatternDepth * glow.w * out_of);
#ifdef TINTS
    albedo *= texelFetch(tints, place(int(number)), 0).rgb;
#endif
    vec3 irradiance = vec3(0);
#if SUNS > 0
    for (int i = 0; i < SUNS; ++i) {
        float cosine = dot(normal, sun_toward[i]);
#ifdef SHADOWS
        if (casts && cosine > 0.0 && in_shadow(i, point, number + 1u)) cosine = 0.0;
#endif
        irradiance += max(0.0, cosine) * sun_irradiance[i];
    }
#endif
#if LAMPS > 0
    for (int i = 0; i < LAMPS; ++i) irradiance += from_lamp(i, vec4(point, body.shift), normal);
#endif
    vec3 seen_normal = normal.xyz / max(1e-6, length(normal.xyz));
    return Lit(glow.rgb + albedo * (sky + kLambert * irradiance), abs(dot(seen_normal, direction)));
}

#ifdef GHOSTS
// The four nearest ghosts before what is solid, one over the other.
vec3 with_ghosts(vec3 behind, uvec4 tile, vec3 direction, float solid) {
    vec4 t = vec4(kFar);
    uvec4 who = uvec4(0u);
    for (uint i = tile.z; i < tile.z + tile.w; ++i) {
        uvec2 entry = texelFetch(list, place(int(i)), 0).xy;
        if (uintBitsToFloat(entry.y) > min(solid, t.w)) break;
        Body body = body_at(entry.x);
        float own = hit_distance(body, form_at(body.form), direction);
        if (own >= solid) continue;
        // Sorted into the four.
        if (own < t.x) t = vec4(own, t.xyz), who = uvec4(entry.x, who.xyz);
        else if (own < t.y) t = vec4(t.x, own, t.yz), who = uvec4(who.x, entry.x, who.yz);
        else if (own < t.z) t = vec4(t.xy, own, t.z), who = uvec4(who.xy, entry.x, who.z);
        else if (own < t.w) t.w = own, who.w = entry.x;
    }
    for (int i = 3; i >= 0; --i) {
        if (t[i] == kFar) continue;
        Lit lit = light_of(who[i], t[i], direction, false);
        // Thin in the middle and thicker at the rim, as a bubble is.
        float opacity = body_at(who[i]).opacity * mix(0.7, 0.2, lit.facing);
        behind = mix(behind, lit.light, opacity);
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
    if (seen.x != 0u) light = light_of(seen.x - 1u, t, direction, true).light;
    if (seen.x == 0u) t = kFar;
#if LAMPS > 0
    for (int i = 0; i < LAMPS; ++i) {
        float own = lamp_power[i].w > 0.0 ? lamp_distance(i, direction) : kFar;
        if (own < t) t = own, light = lamp_power[i].rgb;
    }
#endif
#ifdef GHOSTS
    uvec4 tile = texelFetch(tiles, at / tile_size, 0);
    light = with_ghosts(light, tile, direction, t);
#endif
    color = vec4(srgb(gain * light), 1);
#ifdef OUTLINE
    if (on_outline(at, seen.x)) color.rgb = kChosen;
#endif
}
