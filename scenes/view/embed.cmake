# SPDX-License-Identifier: Apache-2.0
# cmake -DFOLDER=... -DOUTPUT=... -DSOURCES="a.js b.glsl" -P embed.cmake: the page's sources as C++,
# so that the program needs no files beside it.
separate_arguments(SOURCES)
set(text "#include \"scenes/view/page.hpp\"\n\nnamespace tesserae::scenes {\n\n")
string(APPEND text "const std::vector<PageSource>& page_sources() {\n")
string(APPEND text "    static const std::vector<PageSource> sources = {\n")
foreach(source IN LISTS SOURCES)
  file(READ ${FOLDER}/${source} content)
  string(APPEND text "        {\"${source}\", R\"PAGE(${content})PAGE\"},\n")
endforeach()
string(APPEND text "    };\n    return sources;\n}\n\n}  // namespace tesserae::scenes\n")
file(WRITE ${OUTPUT} "${text}")
