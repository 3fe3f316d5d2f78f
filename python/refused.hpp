// SPDX-License-Identifier: BSL-1.0
// Refusals as exceptions of Python.
#pragma once

#include <string>

namespace nysalt::python {

/// The sentence with the names of arguments instead of those of options: --sample-every becomes sample_every,
/// and --force becomes force=True. A command line that a sentence proposes stays.
std::string in_words_of_python(const std::string& text);

/// Refusals of the library and the program are a ValueError, once this was called; what fails on the way is a
/// RuntimeError.
void raise_refusals();

}  // namespace nysalt::python
