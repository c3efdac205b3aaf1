// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "core/algebra/bivector.hpp"
#include "core/algebra/vector.hpp"

namespace tesserae {

/// An impulse at a constraint's anchor, and a moment. They act on body b, and their opposites on a.
struct Wrench {
    Vec4 impulse = Vec4::Zero();  ///< world [N s]
    Bivector moment;              ///< about the anchor, world [N m s]

    friend bool operator==(const Wrench& x, const Wrench& y) {
        return x.impulse == y.impulse && x.moment == y.moment;
    }
};

}  // namespace tesserae
