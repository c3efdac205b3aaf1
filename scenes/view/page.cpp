// SPDX-License-Identifier: Apache-2.0
#include "scenes/view/page.hpp"

#include <algorithm>

#include "core/error.hpp"
#include "scenes/process/base64.hpp"

namespace tesserae::scenes {
namespace {

constexpr std::string_view kHashBegin = "<meta name=\"tesserae-scene\" content=\"";
/// What a line of index.html has that is of use where there are joints only.
constexpr std::string_view kForJoints = " data-for=\"joints\"";

std::string_view page_source(std::string_view name) {
    for (const PageSource& there : page_sources())
        if (there.name == name) return there.text;
    throw RunError(fmt::format("the page has no source {}", name));
}

/// What stands between `begin` and the next quotation mark; empty if the line has no `begin`.
std::string_view quoted_after(std::string_view line, std::string_view begin) {
    const auto at = line.find(begin);
    if (at == std::string_view::npos) return {};
    const std::string_view rest = line.substr(at + begin.size());
    return rest.substr(0, rest.find('"'));
}

/// A script's tag with what it names inside it instead.
void append_script(std::string& page, std::string_view line, std::string_view name) {
    const std::string attribute = fmt::format(" src=\"{}\"", name);
    const auto at = line.find(attribute), end = line.find("</script>");
    TSR_ASSERT(at != std::string_view::npos && end != std::string_view::npos && at < end);
    page += line.substr(0, at);
    page += line.substr(at + attribute.size(), end - at - attribute.size());
    page += '\n';
    page += page_source(name);
    page += line.substr(end);
}

}  // namespace

std::string page_text(std::string_view hash, std::string_view scene, std::string_view poses,
                      bool joints) {
    std::string page;
    std::string_view rest = page_source("index.html");
    while (!rest.empty()) {
        const auto length = std::min(rest.find('\n'), rest.size() - 1) + 1;
        const std::string_view line = rest.substr(0, length);
        rest.remove_prefix(length);
        if (!joints && line.find(kForJoints) != std::string_view::npos) continue;
        if (const auto name = quoted_after(line, "<script src=\""); !name.empty()) {
            append_script(page, line, name);
        } else if (const auto shader = quoted_after(line, " src=\""); !shader.empty()) {
            append_script(page, line, shader);
        } else if (const auto style = quoted_after(line, "rel=\"stylesheet\" href=\"");
                   !style.empty()) {
            page += fmt::format("<style>\n{}</style>\n", page_source(style));
        } else if (line.starts_with(kHashBegin)) {
            page += fmt::format("{}{}\">\n", kHashBegin, hash);
        } else if (line.find("id=\"scene-data\"") != std::string_view::npos) {
            page += fmt::format("<script type=\"application/json\" id=\"scene-data\">{}</script>\n",
                                scene);
        } else if (line.find("id=\"pose-data\"") != std::string_view::npos) {
            page += "<script type=\"text/plain\" id=\"pose-data\">";
            page += base64(poses);
            page += "</script>\n";
        } else {
            page += line;
        }
    }
    return page;
}

std::string page_hash(std::string_view beginning) {
    return std::string(quoted_after(beginning, kHashBegin));
}

}  // namespace tesserae::scenes
