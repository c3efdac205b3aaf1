// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "core/error.hpp"

namespace tesserae::scenes {

/// An error at a place of a text.
struct PlacedError : InputError {
    std::size_t line = 0, column = 0;
    PlacedError(const std::string& what, std::size_t at_line, std::size_t at_column)
        : InputError(what), line(at_line), column(at_column) {}
};

/// Several errors, told together: what() has a line for each.
struct InputErrors : InputError {
    std::vector<PlacedError> errors;
    explicit InputErrors(std::vector<PlacedError> all);
};

/// What is wrong with a text: collected, then told at once, in the order of the text.
class ErrorList {
  public:
    /// Runs `work` and keeps the InputError that it throws.
    /// @throws InputErrors   there are as many as are told at once
    template <class Work>
    void collect(const Work& work) {
        try {
            work();
        } catch (const InputError& error) {
            add(error);
        }
    }
    void add(const InputError& error);
    bool is_empty() const { return errors_.empty(); }
    /// @throws InputErrors   something was kept
    void require_none() const;

  private:
    std::vector<PlacedError> errors_;
};

}  // namespace tesserae::scenes
