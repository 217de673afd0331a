# Writes OUTPUT, a C++ source with live_parts() in it, the parts of pages that move. FOLDER holds what is ours; THREE is
# what bundle.cmake made of three.js, LICENSE its licence, DEFORMER what emscripten made of the deformer.
include("${FOLDER}/literals.cmake")
set(live "${FOLDER}/live")

file(WRITE "${OUTPUT}.new" "#include \"page/live/live_parts.h\"\n#include \"page/literal_view.h\"\n\nnamespace vmesh::tool {\nnamespace {\n\n")
add_part(kLivePage "${live}/live.html")
add_part(kLiveStyle "${FOLDER}/page.css" "${live}/live.css")
add_part(kLiveFirst "${live}/contents.js" "${live}/poster.js" "${live}/first.js")
add_part(kLiveScript "${live}/deformer.js" "${live}/motion.js" "${live}/stage.js" "${FOLDER}/scene.js" "${live}/live.js")
add_part(kLiveThree ${THREE})
add_part(kLiveLicense ${LICENSE})
add_part(kLiveDeformer ${DEFORMER})
file(APPEND "${OUTPUT}.new" "\n}  // namespace\n
const LiveParts& live_parts() {
  static constexpr LiveParts kParts{view(kLivePage),  view(kLiveStyle),   view(kLiveFirst), view(kLiveScript),
                                    view(kLiveThree), view(kLiveLicense), view(kLiveDeformer)};
  return kParts;
}

}  // namespace vmesh::tool\n")
file(RENAME "${OUTPUT}.new" "${OUTPUT}")
