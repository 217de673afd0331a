#include <new>
#include <optional>

#include <tbb/global_control.h>

#include "command_line/interrupt.h"
#include "command_line/parse.h"
#include "command_line/quoting.h"
#include "command_line/usage_error.h"

namespace vmesh::tool {
namespace {

/// With as many threads as it is to have.
int run_limited(const Verb& verb, Console& console) {
  std::optional<tbb::global_control> limit;
  if (const int threads = verb.threads(); threads > 0)
    limit.emplace(tbb::global_control::max_allowed_parallelism, static_cast<std::size_t>(threads));
  return verb.run(console);
}

int run_command(int argc, const char* const* argv) {
  Console console;
  const auto fail = [&console](int code, std::string_view message) {
    console.error(message);
    return code;
  };
  try {
    int exit_code = kOk;
    const std::unique_ptr<Verb> verb = parse_arguments(argc, argv, exit_code);
    if (!verb) return exit_code;
    catch_interrupts();
    verb->common().command_line = quoted_command(argc, argv);
    console.set_quiet(verb->common().quiet);
    if (verb->common().slicer) {
      if (verb->common().json == "-")
        throw UsageError("--slicer uses stdout: write the summary to a file (--json FILE)");
      console.tell_by_tags(verb->name());
    }
    return run_limited(*verb, console);
  } catch (const UsageError& error) {
    return fail(kUsage, error.what());
  } catch (const InvalidInput& error) {
    return fail(kBadInput, error.what());
  } catch (const ReadError& error) {
    return fail(kBadInput, error.what());
  } catch (const Unsupported& error) {
    return fail(kUnsupported, error.what());
  } catch (const WriteError& error) {
    return fail(kCannotWrite, error.what());
  } catch (const Cancelled&) {
    return fail(kInterrupted, "interrupted; nothing was written");
  } catch (const std::bad_alloc&) {
    return fail(kUnsupported, "out of memory; nothing was written");
  } catch (const std::exception& error) {
    return fail(kInternal, std::string("a defect of vmesh, please report it: ") + error.what());
  }
}

}  // namespace
}  // namespace vmesh::tool

int main(int argc, char** argv) { return vmesh::tool::run_command(argc, argv); }
