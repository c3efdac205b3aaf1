// SPDX-License-Identifier: Apache-2.0
#include "core/error.hpp"

namespace tesserae {

void assertion_failed(const char* condition, const char* file, int line) {
    throw std::logic_error(fmt::format("{}:{}: broken invariant: {}", file, line, condition));
}

}  // namespace tesserae
