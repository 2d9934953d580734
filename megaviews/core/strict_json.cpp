#include "megaviews/core/strict_json.h"

#include <nlohmann/json.hpp>
#include <set>
#include <string>
#include <vector>

namespace mv {
namespace {

template <typename Json>
Json parseAs(std::string_view text, std::string_view where, ExitCode code) {
    const std::string place(where);
    // A key given twice is more likely a slip than an intention.
    std::vector<std::set<std::string>> seen;
    const auto onEvent = [&](int depth, typename Json::parse_event_t event, Json& parsed) {
        using Event = typename Json::parse_event_t;
        if (depth > kDeepestJson) {
            throw Error(code, place + ": objects and arrays are nested deeper than " +
                                  std::to_string(kDeepestJson));
        }
        if (event == Event::object_start) seen.emplace_back();
        if (event == Event::object_end) seen.pop_back();
        if (event != Event::key) return true;
        const std::string key = parsed.template get<std::string>();
        if (!seen.back().insert(key).second) {
            throw Error(code, place + ": '" + key + "' is given twice");
        }
        return true;
    };
    try {
        return Json::parse(text, onEvent, true, true);
    } catch (const typename Json::exception& error) {
        throw Error(code, place + ": not valid JSON: " + std::string(withoutTag(error.what())));
    }
}

}  // namespace

nlohmann::json parseStrictJson(std::string_view text, std::string_view where, ExitCode code) {
    return parseAs<nlohmann::json>(text, where, code);
}

nlohmann::ordered_json parseOrderedJson(std::string_view text, std::string_view where,
                                        ExitCode code) {
    return parseAs<nlohmann::ordered_json>(text, where, code);
}

std::string_view withoutTag(std::string_view what) {
    const std::size_t end = what.find("] ");
    return end == std::string_view::npos ? what : what.substr(end + 2);
}

}  // namespace mv
