// What kinds of files options take: their type names in the help, by which shells complete.
#pragma once

namespace vmesh::tool {

/// Any file that vmesh reads; "FILE.txt|.md": one with these extensions.
inline constexpr const char* kFile = "FILE";
inline constexpr const char* kSurfaceFile = "SURFACE";        ///< to be written
inline constexpr const char* kCenterlineFile = "CENTERLINE";  ///< to be written
inline constexpr const char* kVolumeFile = "VOLUME";          ///< to be written
inline constexpr const char* kFolder = "FOLDER";

}  // namespace vmesh::tool
