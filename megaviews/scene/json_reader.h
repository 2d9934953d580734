#pragma once
// Reads single values of a JSON object that somebody else wrote: absent, right or refused with the
// place in words. Serves the check of glTF documents.

#include <cstdint>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "megaviews/scene/gltf_report.h"

namespace mv {

// An integer, also when written as 3.0; nothing for other values or beyond 2^53.
std::optional<std::int64_t> integerValue(const nlohmann::json& value);
// Exactly `size` finite numbers (any number of them if size is 0).
std::optional<std::vector<double>> numberArray(const nlohmann::json& value, std::size_t size);

// One object and its place, such as "accessors[3]". Functions return nothing if the key is absent
// and fail through the report if it holds something else.
class JsonReader {
  public:
    JsonReader(const nlohmann::json& object, std::string place, GltfReport& report);

    const nlohmann::json* find(const char* key) const;
    std::string at(const char* key) const { return place_ + "." + key; }
    [[noreturn]] void fail(const char* key, const std::string& reason) const;
    void warn(const char* key, const std::string& reason) const;

    std::optional<std::uint64_t> count(const char* key) const;  // integer >= 0
    std::uint64_t requireCount(const char* key) const;
    // Index into an array of `limit` entries, called `what` in the message.
    std::optional<std::size_t> index(const char* key, std::size_t limit, const char* what) const;
    std::size_t requireIndex(const char* key, std::size_t limit, const char* what) const;
    std::optional<std::vector<double>> numbers(const char* key, std::size_t size) const;
    std::optional<std::string> text(const char* key) const;
    // Empty array if absent.
    const nlohmann::json& array(const char* key) const;
    // A child object, or an empty one if absent.
    JsonReader object(const char* key) const;
    JsonReader extension(const char* name) const;
    bool hasExtension(const char* name) const;
    // Names are decoration: what is not a string is no name.
    std::string name() const;

    // What may be repaired: a number or numbers, else a warning and nothing.
    std::optional<double> numberOrWarn(const char* key) const;
    std::optional<std::vector<double>> numbersOrWarn(const char* key, std::size_t size) const;

    const nlohmann::json& json() const { return *object_; }
    const std::string& place() const { return place_; }
    GltfReport& report() const { return *report_; }

  private:
    const nlohmann::json* object_;
    std::string place_;
    GltfReport* report_;
};

}  // namespace mv
