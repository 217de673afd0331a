#pragma once

namespace vmesh::tool {

/// From now on, the first SIGINT or SIGTERM only sets a flag and ends waits for a pipe; a second one ends the process
/// at once. Writing beyond the file size limit fails instead of ending the process.
void catch_interrupts();

/// Whether the flag is set.
bool interrupted() noexcept;

/// Throws Cancelled if the flag is set. To be called between stages that do not report progress.
void stop_if_interrupted();

}  // namespace vmesh::tool
