// SPDX-License-Identifier: BSL-1.0
// A crash in a user's code names the plug-in.
#pragma once

#include <string>

namespace nysalt::program {

/// In a program that owns its signals: to be called at its start. Without it name_signals() does nothing.
void allow_named_signals();

/// From now on a signal that ends the program (SIGSEGV, SIGBUS, SIGFPE, SIGILL, SIGABRT) writes a line with
/// its name and the plug-in's on standard error first; on the thread that loads the plug-in also where the
/// stack overflowed. So does exit(), until allow_exit(); the exit code is 2 then.
void name_signals(const std::string& plugin);

/// The program itself ends now.
void allow_exit();

}  // namespace nysalt::program
