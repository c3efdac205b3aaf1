#pragma once

namespace tesserae {

/// The name of a key of scene files, with what their reference says about it. One without a
/// sentence does not compile.
struct Key {
    const char* name;
    const char* unit;     ///< as in "m/s"; empty: it has none
    const char* meaning;  ///< a sentence; more may follow
    /// What holds where the key is absent, in words; null: the value that the reader starts from.
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
