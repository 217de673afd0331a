# Writes OUTPUT, a C++ source with page_parts() in it. FOLDER holds the parts that are ours; THREE is what
# bundle.cmake made of three.js and LICENSE its licence, empty when they are not there.
set(scripts decode colors legend surface scene camera frames panel cut ruler save main)

# A raw string literal of at most 64 kB each: compilers need take no more.
function(append_literal text)
  string(LENGTH "${text}" length)
  set(begin 0)
  set(literal "")
  while(begin LESS length)
    string(SUBSTRING "${text}" ${begin} 16000 piece)
    string(APPEND literal "R\"vmesh_part(${piece})vmesh_part\"\n")
    math(EXPR begin "${begin} + 16000")
  endwhile()
  if(length EQUAL 0)
    set(literal "\"\"")
  endif()
  set(literal "${literal}" PARENT_SCOPE)
endfunction()

function(add_part name)
  set(text "")
  foreach(file ${ARGN})
    file(READ "${file}" content)
    string(APPEND text "${content}")
  endforeach()
  append_literal("${text}")
  file(APPEND "${OUTPUT}.new" "constexpr char ${name}[] =\n${literal};\n")
endfunction()

list(TRANSFORM scripts PREPEND "${FOLDER}/")
list(TRANSFORM scripts APPEND ".js")
file(WRITE "${OUTPUT}.new" "#include \"page/page_parts.h\"\n\nnamespace vmesh::tool {\nnamespace {\n\n")
add_part(kPage "${FOLDER}/page.html")
add_part(kStyle "${FOLDER}/page.css")
add_part(kScript ${scripts})
add_part(kThree ${THREE})
add_part(kLicense ${LICENSE})
file(APPEND "${OUTPUT}.new" "\n}  // namespace\n
template <std::size_t size>
constexpr std::string_view view(const char (&text)[size]) {
  return {text, size - 1};
}

const PageParts& page_parts() {
  static constexpr PageParts kParts{view(kPage), view(kStyle), view(kScript), view(kThree), view(kLicense)};
  return kParts;
}

}  // namespace vmesh::tool\n")
file(RENAME "${OUTPUT}.new" "${OUTPUT}")
