// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "core/dynamics/bodies/bodies.hpp"
#include "render/description.hpp"

namespace tesserae::render {

/// What a body's albedo is multiplied by, so that equal bodies beside each other can be told apart:
/// each colour's factor is random between 1 - variation and 1, by three quarters the same for all
/// of them. A function of the body's number.
Color tint_of(BodyId body, double variation);

/// A colour with its hue turned by a part of the colour circle; saturation and brightness stay.
Color turned_hue(const Color& color, double turn);
/// How far a body's hue is turned, so that bodies of one material differ: random, within half of
/// `jitter` to either side. A function of the body's number.
double hue_turn_of(BodyId body, double jitter);

}  // namespace tesserae::render
