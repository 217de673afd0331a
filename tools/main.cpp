#include <new>
#include <optional>

#include <tbb/global_control.h>

#include "command_line/exit_code.h"
#include "command_line/inputs.h"
#include "command_line/interrupt.h"
#include "command_line/quoting.h"
#include "command_line/usage_error.h"
#include "verbs/verbs.h"

namespace vmesh::tool {
namespace {

/// --threads of a verb; 0 if not given, or if it has no such option.
template <class VerbArguments>
int threads_of(const VerbArguments& verb) {
  if constexpr (requires { verb.threads; }) return verb.threads;
  if constexpr (requires { verb.production; }) return verb.production.growth.threads;
  if constexpr (requires { verb.generate.production; }) return verb.generate.production.growth.threads;
  if constexpr (requires { verb.options.threads; }) return verb.options.threads;
  return 0;
}

int run_verb(const Arguments& arguments, Console& console) {
  return std::visit(
      [&console](const auto& verb) {
        console.set_quiet(verb.common.quiet);
        std::optional<tbb::global_control> limit;
        if (const int threads = threads_of(verb); threads > 0)
          limit.emplace(tbb::global_control::max_allowed_parallelism, static_cast<std::size_t>(threads));
        return run(verb, console);
      },
      arguments);
}

int run_command(int argc, const char* const* argv) {
  Console console;
  const auto fail = [&console](int code, std::string_view message) {
    console.error(message);
    return code;
  };
  try {
    int exit_code = kOk;
    std::optional<Arguments> arguments = parse_arguments(argc, argv, exit_code);
    if (!arguments) return exit_code;
    catch_interrupts();
    std::visit(
        [argc, argv](auto& verb) {
          verb.common.command_line = quoted_command(argc, argv);
          expand_all_folders(verb);
        },
        *arguments);
    return run_verb(*arguments, console);
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
