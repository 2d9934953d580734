#include "megaviews/scene/json_reader.h"

#include <cmath>

namespace mv {

namespace {

using Json = nlohmann::json;
const Json kEmptyObject = Json::object();
const Json kEmptyArray = Json::array();

}  // namespace

std::optional<std::int64_t> integerValue(const Json& value) {
    constexpr double kLargest = 9007199254740992.0;  // 2^53
    if (!value.is_number()) return std::nullopt;
    const auto number = value.get<double>();
    if (!(std::abs(number) <= kLargest) || number != std::floor(number)) return std::nullopt;
    return static_cast<std::int64_t>(number);
}

std::optional<std::vector<double>> numberArray(const Json& value, std::size_t size) {
    if (!value.is_array() || (size > 0 && value.size() != size)) return std::nullopt;
    std::vector<double> numbers;
    numbers.reserve(value.size());
    for (const Json& entry : value) {
        if (!entry.is_number()) return std::nullopt;
        numbers.push_back(entry.get<double>());
        if (!std::isfinite(numbers.back())) return std::nullopt;
    }
    return numbers;
}

JsonReader::JsonReader(const Json& object, std::string place, GltfReport& report)
    : object_(&object), place_(std::move(place)), report_(&report) {
    if (!object.is_object()) report.fail(place_, "it must be an object");
}

const Json* JsonReader::find(const char* key) const {
    const auto it = object_->find(key);
    return it == object_->end() ? nullptr : &*it;
}

void JsonReader::fail(const char* key, const std::string& reason) const {
    report_->fail(at(key), reason);
}

void JsonReader::warn(const char* key, const std::string& reason) const {
    report_->warn(at(key), reason);
}

std::optional<std::uint64_t> JsonReader::count(const char* key) const {
    const Json* value = find(key);
    if (!value) return std::nullopt;
    const auto number = integerValue(*value);
    if (!number) fail(key, "it must be an integer");
    if (*number < 0) fail(key, "it is negative (" + std::to_string(*number) + ")");
    return static_cast<std::uint64_t>(*number);
}

std::uint64_t JsonReader::requireCount(const char* key) const {
    const auto value = count(key);
    if (!value) fail(key, "it is missing");
    return *value;
}

std::optional<std::size_t> JsonReader::index(const char* key, std::size_t limit,
                                             const char* what) const {
    const auto value = count(key);
    if (value && *value >= limit) {
        fail(key, std::string("it refers to ") + what + " " + std::to_string(*value) +
                      ", but the file has " + std::to_string(limit));
    }
    return value;
}

std::size_t JsonReader::requireIndex(const char* key, std::size_t limit, const char* what) const {
    const auto value = index(key, limit, what);
    if (!value) fail(key, "it is missing");
    return *value;
}

std::optional<std::vector<double>> JsonReader::numbers(const char* key, std::size_t size) const {
    const Json* value = find(key);
    if (!value) return std::nullopt;
    auto result = numberArray(*value, size);
    if (!result) {
        fail(key, size > 0 ? "it must be an array of " + std::to_string(size) + " finite numbers"
                           : "it must be an array of finite numbers");
    }
    return result;
}

std::optional<std::string> JsonReader::text(const char* key) const {
    const Json* value = find(key);
    if (!value) return std::nullopt;
    if (!value->is_string()) fail(key, "it must be a string");
    return value->get<std::string>();
}

const Json& JsonReader::array(const char* key) const {
    const Json* value = find(key);
    if (!value) return kEmptyArray;
    if (!value->is_array()) fail(key, "it must be an array");
    return *value;
}

JsonReader JsonReader::object(const char* key) const {
    const Json* value = find(key);
    return JsonReader(value ? *value : kEmptyObject, at(key), *report_);
}

JsonReader JsonReader::extension(const char* name) const {
    return object("extensions").object(name);
}

bool JsonReader::hasExtension(const char* name) const {
    const Json* extensions = find("extensions");
    return extensions && extensions->is_object() && extensions->contains(name);
}

std::string JsonReader::name() const {
    const Json* value = find("name");
    return value && value->is_string() ? printable(value->get_ref<const std::string&>()) : "";
}

std::optional<double> JsonReader::numberOrWarn(const char* key) const {
    const Json* value = find(key);
    if (!value) return std::nullopt;
    if (value->is_number() && std::isfinite(value->get<double>())) return value->get<double>();
    warn(key, "it is not a finite number, the default is taken");
    return std::nullopt;
}

std::optional<std::vector<double>> JsonReader::numbersOrWarn(const char* key,
                                                             std::size_t size) const {
    const Json* value = find(key);
    if (!value) return std::nullopt;
    auto result = numberArray(*value, size);
    if (!result) {
        warn(key, "it is not an array of " + std::to_string(size) +
                      " finite numbers, the default is taken");
    }
    return result;
}

}  // namespace mv
