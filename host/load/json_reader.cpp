#include "load/json_reader.h"

#include "load/context.h"

#include <fmt/format.h>

#include <algorithm>

namespace isolux {
namespace {

using nlohmann::json;

constexpr std::size_t kDeepest = 128;
constexpr std::size_t kMostValues = std::size_t{1} << 24; // about 1 GB as a document in memory

/// Skips a string that starts at text[i]; returns the position of its closing quote, or the end.
std::size_t skipString(std::string_view text, std::size_t i) {
    for (++i; i < text.size() && text[i] != '"'; ++i)
        if (text[i] == '\\') ++i;
    return i;
}

/// Bounds depth and values by a scan that needs no stack: recursive parsers and destructors die of deep documents.
void boundJson(std::string_view text, const LoadContext& context) {
    std::size_t depth = 0;
    std::size_t values = 0;
    for (std::size_t i = 0; i < text.size(); ++i) {
        const char c = text[i];
        if (c == '"') i = skipString(text, i);
        if (c == '[' || c == '{') ++depth;
        if ((c == ']' || c == '}') && depth > 0) --depth;
        if (c == '[' || c == '{' || c == ',') ++values;
        if (depth > kDeepest) context.fail("", fmt::format("its JSON is nested deeper than {} levels", kDeepest));
        if (values > kMostValues) context.fail("", fmt::format("its JSON has more than {} values", kMostValues));
    }
}

std::string locate(std::string_view text, std::size_t position) {
    const std::string_view before = text.substr(0, position);
    const std::size_t lineStart = before.rfind('\n') + 1; // npos + 1 is 0: the first line
    return fmt::format("line {}, column {}", 1 + std::count(before.begin(), before.end(), '\n'),
                       position - lineStart + 1);
}

} // namespace

std::string escapedKey(std::string_view key) {
    std::string result;
    for (const char c : key) {
        if (c == '~')
            result += "~0";
        else if (c == '/')
            result += "~1";
        else
            result += c;
    }
    return result;
}

/// Where the parser stops at a number that double cannot hold: its exception does not say.
class NumberTooLarge : public nlohmann::json_sax<json> {
public:
    std::size_t position = 0;

    bool null() override { return true; }
    bool boolean(bool) override { return true; }
    bool number_integer(number_integer_t) override { return true; }
    bool number_unsigned(number_unsigned_t) override { return true; }
    bool number_float(number_float_t, const string_t&) override { return true; }
    bool string(string_t&) override { return true; }
    bool binary(binary_t&) override { return true; }
    bool start_object(std::size_t) override { return true; }
    bool key(string_t&) override { return true; }
    bool end_object() override { return true; }
    bool start_array(std::size_t) override { return true; }
    bool end_array() override { return true; }
    bool parse_error(std::size_t at, const std::string&, const nlohmann::detail::exception&) override {
        position = at > 0 ? at - 1 : 0;
        return false;
    }
};

json parseJson(std::string_view text, const LoadContext& context) {
    boundJson(text, context);
    try {
        return json::parse(text.begin(), text.end());
    } catch (const json::parse_error& error) {
        const std::size_t position = error.byte > 0 ? error.byte - 1 : 0;
        context.fail("", "it is neither GLB nor valid JSON: error at " + locate(text, std::min(position, text.size())));
    } catch (const json::exception&) {
        NumberTooLarge handler;
        json::sax_parse(text.begin(), text.end(), &handler);
        context.fail("", "its JSON holds a number too large to represent at " +
                             locate(text, std::min(handler.position, text.size())));
    }
}

void JsonReader::fail(std::string_view message) const { context_->fail(pointer_, message); }
void JsonReader::warn(std::string_view message) const { context_->warn(pointer_, message); }

void JsonReader::requireObject() const {
    if (!value_->is_object()) fail(fmt::format("must be an object, not {}", value_->type_name()));
}

std::optional<JsonReader> JsonReader::find(std::string_view key) const {
    requireObject();
    const auto member = value_->find(key);
    if (member == value_->end()) return std::nullopt;
    return JsonReader(*member, fmt::format("{}/{}", pointer_, escapedKey(key)), *context_);
}

JsonReader JsonReader::at(std::string_view key) const {
    const std::optional<JsonReader> member = find(key);
    if (!member) context_->fail(fmt::format("{}/{}", pointer_, key), "is missing");
    return *member;
}

std::vector<std::string> JsonReader::keys() const {
    requireObject();
    std::vector<std::string> keys;
    for (const auto& item : value_->items()) keys.push_back(item.key());
    return keys;
}

std::size_t JsonReader::size() const {
    if (!value_->is_array()) fail(fmt::format("must be an array, not {}", value_->type_name()));
    return value_->size();
}

JsonReader JsonReader::element(std::size_t index) const {
    if (index >= size()) fail(fmt::format("must have at least {} elements", index + 1));
    return {(*value_)[index], fmt::format("{}/{}", pointer_, index), *context_};
}

std::size_t JsonReader::sizeOf(std::string_view key) const {
    const std::optional<JsonReader> member = find(key);
    return member ? member->size() : 0;
}

const std::string& JsonReader::string() const {
    if (!value_->is_string()) fail(fmt::format("must be a string, not {}", value_->type_name()));
    return value_->get_ref<const std::string&>();
}

bool JsonReader::boolean() const {
    if (!value_->is_boolean()) fail(fmt::format("must be true or false, not {}", value_->type_name()));
    return value_->get<bool>();
}

double JsonReader::number() const {
    if (!value_->is_number()) fail(fmt::format("must be a number, not {}", value_->type_name()));
    return value_->get<double>();
}

double JsonReader::numberBetween(double lowest, double highest) const {
    const double value = number();
    if (!(value >= lowest && value <= highest))
        fail(fmt::format("is {} but must lie in [{}, {}]", value, lowest, highest));
    return value;
}

std::uint64_t JsonReader::integer() const {
    if (!value_->is_number_unsigned())
        fail(fmt::format("must be a non-negative integer, not {}",
                         value_->is_number() ? value_->dump() : value_->type_name()));
    return value_->get<std::uint64_t>();
}

std::uint64_t JsonReader::integerBetween(std::uint64_t lowest, std::uint64_t highest) const {
    const std::uint64_t value = integer();
    if (value < lowest || value > highest) fail(fmt::format("is {} but must lie in [{}, {}]", value, lowest, highest));
    return value;
}

std::size_t JsonReader::index(std::size_t count, std::string_view target) const {
    const std::uint64_t value = integer();
    if (value >= count) fail(fmt::format("refers to {} {}, but there are only {} of them", target, value, count));
    return static_cast<std::size_t>(value);
}

JsonReader JsonReader::elementOf(const JsonReader& root, std::string_view target) const {
    const std::size_t position = index(root.sizeOf(target), target);
    return root.at(target).element(position);
}

json JsonReader::numbers(std::size_t count) const {
    if (size() != count) fail(fmt::format("must have {} numbers, not {}", count, size()));
    json result = json::array();
    for (std::size_t i = 0; i < count; ++i) result.push_back(element(i).number());
    return result;
}

json JsonReader::numbersBetween(std::size_t count, double lowest, double highest) const {
    json result = numbers(count);
    for (std::size_t i = 0; i < count; ++i) (void)element(i).numberBetween(lowest, highest);
    return result;
}

} // namespace isolux
