#pragma once
// The options of a command of megaviews-bench, by CLI11.

#include <CLI/CLI.hpp>
#include <cstdio>
#include <string>
#include <vector>

#include "megaviews/core/error.h"

namespace mv {

// False: --help was given and answered. Throws Error(ExitCode::usage).
inline bool parseOptions(CLI::App& app, const std::vector<std::string>& arguments) {
    try {
        app.parse(std::vector<std::string>(arguments.rbegin(), arguments.rend()));
    } catch (const CLI::CallForHelp&) {
        std::fputs(app.help().c_str(), stdout);
        return false;
    } catch (const CLI::ParseError& error) {
        const std::string& name = app.get_name();  // "megaviews-bench compare"
        throw Error(ExitCode::usage, name.substr(name.find(' ') + 1) + ": " + error.what());
    }
    for (const CLI::Option* option : app.get_options()) {
        for (const std::string& value : option->results()) {
            if (!value.empty()) continue;
            throw Error(ExitCode::usage, option->get_name() + ": its value is empty");
        }
    }
    return true;
}

}  // namespace mv
