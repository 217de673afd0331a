#pragma once

namespace vmesh::tool {

/// From now on the first SIGINT or SIGTERM only sets a flag, and ends waits for a pipe; a second one ends the process
/// at once. Writing beyond the limit of file sizes fails instead of ending the process.
void catch_interrupts();

/// Whether the flag is set.
bool interrupted() noexcept;

/// Throws Cancelled when the flag is set. Call between stages that do not report progress.
void stop_if_interrupted();

}  // namespace vmesh::tool
