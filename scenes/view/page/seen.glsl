// First pass: what each pixel sees. Follows shapes.glsl.
out uvec2 seen;  // number of the body + 1, or 0; its distance along the ray as bits of a float

void main() {
    vec3 direction = view_direction(gl_FragCoord.xy);
    uvec4 tile = texelFetch(tiles, ivec2(gl_FragCoord.xy) / tile_size, 0);
    float nearest = limit;
    uint who = 0u;
    // The list begins with what may be nearest: once that lies behind a hit, so does the rest.
    for (uint i = tile.x; i < tile.x + tile.y; ++i) {
        uvec2 entry = texelFetch(list, place(int(i)), 0).xy;
        if (uintBitsToFloat(entry.y) > nearest) break;
        Body body = body_at(entry.x);
        float t = hit_distance(body, form_at(body.form), direction);
        if (t < nearest || (t == nearest && t < limit && entry.x + 1u < who)) {
            nearest = t;
            who = entry.x + 1u;
        }
    }
    seen = uvec2(who, floatBitsToUint(nearest));
}
