// Untrusted JSON: a bounded parse, and a view that checks the type of everything taken from it.
#pragma once

#include <nlohmann/json.hpp>

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

namespace isolux {

class LoadContext;

/// Parses text after bounding its nesting and its number of values, on which memory and stack depend.
[[nodiscard]] nlohmann::json parseJson(std::string_view text, const LoadContext& context);

/// A key as part of a JSON pointer (RFC 6901, 3).
[[nodiscard]] std::string escapedKey(std::string_view key);

/// A JSON value together with its pointer. Every function that finds another type than asked for throws Error naming
/// it.
class JsonReader {
public:
    JsonReader(const nlohmann::json& value, std::string pointer, LoadContext& context)
        : value_(&value), pointer_(std::move(pointer)), context_(&context) {}

    [[nodiscard]] const std::string& pointer() const { return pointer_; }
    [[nodiscard]] LoadContext& context() const { return *context_; }
    [[nodiscard]] const nlohmann::json& value() const { return *value_; }
    [[nodiscard]] bool isObject() const { return value_->is_object(); }

    /// Member of an object: required, or if it is there.
    [[nodiscard]] JsonReader at(std::string_view key) const;
    [[nodiscard]] std::optional<JsonReader> find(std::string_view key) const;
    [[nodiscard]] std::vector<std::string> keys() const;

    /// Array access. `sizeOf` is the size of an array member, 0 if it is absent.
    [[nodiscard]] std::size_t size() const;
    [[nodiscard]] JsonReader element(std::size_t index) const;
    [[nodiscard]] std::size_t sizeOf(std::string_view key) const;

    [[nodiscard]] const std::string& string() const; ///< lives as long as the document
    [[nodiscard]] bool boolean() const;
    [[nodiscard]] double number() const;
    [[nodiscard]] double numberBetween(double lowest, double highest) const;
    [[nodiscard]] std::uint64_t integer() const; ///< non-negative
    [[nodiscard]] std::uint64_t integerBetween(std::uint64_t lowest, std::uint64_t highest) const;
    /// An index into the document's array `target`, which has `count` elements.
    [[nodiscard]] std::size_t index(std::size_t count, std::string_view target) const;
    /// The element of the document's array `target` that this is the index of.
    [[nodiscard]] JsonReader elementOf(const JsonReader& root, std::string_view target) const;
    /// An array of exactly `count` numbers.
    [[nodiscard]] nlohmann::json numbers(std::size_t count) const;
    [[nodiscard]] nlohmann::json numbersBetween(std::size_t count, double lowest, double highest) const;

    [[noreturn]] void fail(std::string_view message) const;
    void warn(std::string_view message) const;

private:
    void requireObject() const;

    const nlohmann::json* value_;
    std::string pointer_;
    LoadContext* context_;
};

} // namespace isolux
