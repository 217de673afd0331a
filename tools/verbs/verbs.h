#pragma once

#include "command_line/arguments.h"
#include "command_line/console.h"

namespace vmesh::tool {

/// One function per verb. Returns the exit code; throws like the library, and UsageError.
int run(const GenerateArguments& arguments, Console& console);
int run(const InfoArguments& arguments, Console& console);
int run(const SynthArguments& arguments, Console& console);
int run(const ConvertArguments& arguments, Console& console);
int run(const RenderArguments& arguments, Console& console);
int run(const EvaluateArguments& arguments, Console& console);
int run(const ReferenceArguments& arguments, Console& console);
int run(const ConesArguments& arguments, Console& console);
int run(const CenterlineArguments& arguments, Console& console);
int run(const Table2Arguments& arguments, Console& console);
int run(const TradeoffArguments& arguments, Console& console);
int run(const DeformArguments& arguments, Console& console);
int run(const Table1Arguments& arguments, Console& console);
int run(const FitArguments& arguments, Console& console);
int run(const SplitArguments& arguments, Console& console);
int run(const JoinArguments& arguments, Console& console);
/// A part of a surface.
int run_part(const GenerateArguments& arguments, Console& console);

}  // namespace vmesh::tool
