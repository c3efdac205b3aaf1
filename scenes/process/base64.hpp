// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <string_view>

namespace tesserae::scenes {

/// Bytes as text: RFC 4648, section 4, padded, in one line.
std::string base64(std::string_view bytes);

}  // namespace tesserae::scenes
