# Writes OUTPUT, a C++ source with page_parts() in it. FOLDER holds the parts that are ours; THREE is what
# bundle.cmake made of three.js and LICENSE its licence, empty when they are not there.
set(scripts decode colors legend surface scene camera frames panel cut ruler save main)

include("${CMAKE_CURRENT_LIST_DIR}/literals.cmake")

list(TRANSFORM scripts PREPEND "${FOLDER}/")
list(TRANSFORM scripts APPEND ".js")
file(WRITE "${OUTPUT}.new" "#include \"page/page_parts.h\"\n#include \"page/literal_view.h\"\n\nnamespace vmesh::tool {\nnamespace {\n\n")
add_part(kPage "${FOLDER}/page.html")
add_part(kStyle "${FOLDER}/page.css")
add_part(kScript ${scripts})
add_part(kThree ${THREE})
add_part(kLicense ${LICENSE})
file(APPEND "${OUTPUT}.new" "\n}  // namespace\n
const PageParts& page_parts() {
  static constexpr PageParts kParts{view(kPage), view(kStyle), view(kScript), view(kThree), view(kLicense)};
  return kParts;
}

}  // namespace vmesh::tool\n")
file(RENAME "${OUTPUT}.new" "${OUTPUT}")
