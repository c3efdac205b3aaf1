// SPDX-License-Identifier: Apache-2.0
#pragma once

namespace tesserae {

/// A Key is the name of a key of scene files, with the text that their reference has about it. A
/// key without a sentence does not compile.
struct Key {
    const char* name;
    const char* unit;     ///< for example "m/s"; empty for none
    const char* meaning;  ///< one sentence or more
    /// This says in words what holds if the key is absent. If null, the reference shows the value
    /// that the reader starts from.
    const char* otherwise = nullptr;

    consteval Key(const char* key, const char* in, const char* says,
                  const char* if_absent = nullptr)
        : name(key), unit(in), meaning(says), otherwise(if_absent) {
        if (!is_sentence(says)) throw "a key needs a sentence that says what it means";
    }

  private:
    static consteval bool is_sentence(const char* text) {
        if (text[0] < 'A' || text[0] > 'Z') return false;
        const char* end = text;
        while (*end != '\0') ++end;
        return end - text >= 12 && end[-1] == '.';
    }
};

}  // namespace tesserae
