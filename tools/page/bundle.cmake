# Writes OUTPUT, a script that defines THREE: those parts of three.js, a package of npm in the folder PACKAGE, that our
# scripts in FOLDER and the script MORE, if any, use, bundled by ESBUILD. A part that the package has not stops the build.
file(GLOB scripts "${FOLDER}/*.js" ${MORE})
set(names "")
foreach(script ${scripts})
  file(READ "${script}" text)
  string(REGEX MATCHALL "THREE\\.[A-Za-z0-9_]+" found "${text}")
  list(APPEND names ${found})
endforeach()
list(TRANSFORM names REPLACE "^THREE\\." "")
list(SORT names)
list(REMOVE_DUPLICATES names)
list(REMOVE_ITEM names OrbitControls)
list(JOIN names ", " names)

set(module "${PACKAGE}/build/three.module.js")
file(WRITE "${OUTPUT}.entry.mjs" "export { ${names} } from \"${module}\";
export { OrbitControls } from \"${PACKAGE}/examples/jsm/controls/OrbitControls.js\";\n")
execute_process(COMMAND_ERROR_IS_FATAL ANY
  COMMAND "${ESBUILD}" "${OUTPUT}.entry.mjs" --bundle --minify --format=iife --global-name=THREE --target=es2020
    --legal-comments=none --charset=utf8 "--alias:three=${module}" --log-level=warning "--outfile=${OUTPUT}")
