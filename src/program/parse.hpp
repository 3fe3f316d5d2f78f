// SPDX-License-Identifier: BSL-1.0
// Reading of a command line, with errors in our own sentences.
#pragma once

#include <CLI/CLI.hpp>
#include <optional>
#include <string>

namespace nysalt::program {

/// The text after a name on the command line, or the name and an =; the last if there are several.
std::string typed_after(const std::string& name, int argc, char** argv);

/// The help or the version, if that is asked for; else all options are read. The file of
/// --config is noted as an input. An app may read several lines. Throws refusal, also for a text that is
/// empty.
std::optional<std::string> parse(CLI::App& app, int argc, char** argv);

}  // namespace nysalt::program
