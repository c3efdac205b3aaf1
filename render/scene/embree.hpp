// SPDX-License-Identifier: Apache-2.0
#pragma once

// Embree 3 and 4 by one set of names; CMake finds one and says which. Only for sources that talk to
// Embree: no public header includes this.
#if TESSERAE_EMBREE == 4
#include <embree4/rtcore.h>
#else
#include <embree3/rtcore.h>
#endif

namespace tesserae::render {

#if TESSERAE_EMBREE == 4
using RayContext = RTCRayQueryContext;
#else
using RayContext = RTCIntersectContext;
#endif

/// A context for single rays, as Embree wants it at the start.
inline RayContext ray_context() {
    RayContext context;
#if TESSERAE_EMBREE == 4
    rtcInitRayQueryContext(&context);
#else
    rtcInitIntersectContext(&context);
#endif
    return context;
}

/// Finds the ray's nearest hit; callbacks of user geometry get the context's address.
inline void intersect(RTCScene scene, RayContext& context, RTCRayHit& ray) {
#if TESSERAE_EMBREE == 4
    RTCIntersectArguments arguments;
    rtcInitIntersectArguments(&arguments);
    arguments.context = &context;
    rtcIntersect1(scene, &ray, &arguments);
#else
    rtcIntersect1(scene, &context, &ray);
#endif
}

}  // namespace tesserae::render
