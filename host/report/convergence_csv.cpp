// convergence.csv: the fields of ErrorSample in order, RFC 4180, unknown figures empty.
#include "core/error.h"
#include "report/convergence.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <charconv>
#include <cmath>

namespace isolux {
namespace {

constexpr const char* kHeader =
    "variant,seed,checkpoint,samples_per_pixel,rays,device_seconds,wall_seconds,setup_seconds,mse,rel_mse,"
    "rel_mse_trimmed,mae,flip,bias,relative_rmse,estimate";

constexpr std::size_t kFieldCount = 16;

// --- Writing ---

std::string quoted(const std::string& text) {
    if (text.find_first_of(",\"\r\n") == std::string::npos) return text;
    std::string result = "\"";
    for (const char c : text) result += c == '"' ? std::string("\"\"") : std::string(1, c);
    return result + "\"";
}

/// In the shortest form that reads back exactly.
std::string field(double value) { return std::isnan(value) ? "," : fmt::format(",{}", value); }

// --- Reading ---

struct Record {
    std::size_t line = 0; ///< where it begins
    std::vector<std::string> fields;
};

/// The records of a text, one after the other; a quoted field may hold commas, ends of line and doubled quotes.
class RecordReader {
public:
    RecordReader(const std::string& text, const std::string& where) : text_(text), where_(where) {}

    [[nodiscard]] bool done() const { return at_ >= text_.size(); }

    Record next() {
        Record record{line_, {}};
        do record.fields.push_back(text_.compare(at_, 1, "\"") == 0 ? quotedField() : plainField());
        while (take(','));
        take('\r');
        if (!take('\n') && !done()) fail("a quote in the middle of a field");
        ++line_;
        return record;
    }

private:
    std::string plainField() {
        const std::size_t begin = at_;
        at_ = std::min(text_.find_first_of(",\"\r\n", at_), text_.size());
        return text_.substr(begin, at_ - begin);
    }

    std::string quotedField() {
        std::string result;
        ++at_;
        while (!done()) {
            const char c = text_[at_++];
            if (c == '"' && !take('"')) return result;
            line_ += c == '\n' ? 1 : 0;
            result += c;
        }
        fail("a quoted field without end");
    }

    bool take(char c) {
        if (done() || text_[at_] != c) return false;
        ++at_;
        return true;
    }

    [[noreturn]] void fail(const char* what) const { throwBadInput(fmt::format("{}:{}", where_, line_), what); }

    const std::string& text_;
    const std::string& where_;
    std::size_t at_ = 0;
    std::size_t line_ = 1;
};

/// Takes the fields of a record one by one.
class FieldReader {
public:
    FieldReader(const Record& record, const std::string& where) : record_(record), where_(where) {
        if (record.fields.size() != kFieldCount)
            fail(fmt::format("{} fields where {} are expected", record.fields.size(), kFieldCount));
    }

    const std::string& text() { return record_.fields[next_++]; }

    template <typename Number> Number number() {
        const std::string& field = text();
        Number value{};
        const auto [stop, error] = std::from_chars(field.data(), field.data() + field.size(), value);
        if (error != std::errc() || stop != field.data() + field.size())
            fail(fmt::format("field {}: \"{}\" is not a number that fits here", next_, field));
        return value;
    }

    double numberOrUnknown() {
        if (!record_.fields[next_].empty()) return number<double>();
        ++next_;
        return std::numeric_limits<double>::quiet_NaN();
    }

    std::uint64_t countOrNone() {
        if (!record_.fields[next_].empty()) return number<std::uint64_t>();
        ++next_;
        return 0;
    }

private:
    [[noreturn]] void fail(const std::string& what) const {
        throwBadInput(fmt::format("{}:{}", where_, record_.line), what);
    }

    const Record& record_;
    const std::string& where_;
    std::size_t next_ = 0;
};

ErrorSample readSample(const Record& record, const std::string& where) {
    FieldReader fields(record, where);
    ErrorSample sample;
    sample.variant = fields.text();
    sample.seed = fields.number<std::uint64_t>();
    sample.checkpoint = fields.number<std::uint32_t>();
    sample.samplesPerPixel = fields.number<double>();
    sample.rays = fields.countOrNone();
    sample.deviceSeconds = fields.numberOrUnknown();
    sample.wallSeconds = fields.number<double>();
    for (double ErrorSample::*figure : {&ErrorSample::setupSeconds, &ErrorSample::mse, &ErrorSample::relMse,
                                        &ErrorSample::relMseTrimmed, &ErrorSample::mae, &ErrorSample::flip,
                                        &ErrorSample::bias, &ErrorSample::relativeRmse, &ErrorSample::estimate})
        sample.*figure = fields.numberOrUnknown();
    return sample;
}

} // namespace

std::string toCsv(const std::vector<ErrorSample>& samples) {
    std::string text = std::string(kHeader) + "\n";
    for (const ErrorSample& sample : samples) {
        text += fmt::format("{},{},{}", quoted(sample.variant), sample.seed, sample.checkpoint) +
                field(sample.samplesPerPixel) + fmt::format(",{}", sample.rays) + field(sample.deviceSeconds) +
                field(sample.wallSeconds) + field(sample.setupSeconds) + field(sample.mse) + field(sample.relMse) +
                field(sample.relMseTrimmed) + field(sample.mae) + field(sample.flip) + field(sample.bias) +
                field(sample.relativeRmse) + field(sample.estimate) + "\n";
    }
    return text;
}

std::vector<ErrorSample> fromCsv(const std::string& text, const std::string& where) {
    RecordReader reader(text, where);
    std::vector<ErrorSample> samples;
    if (reader.done() || fmt::format("{}", fmt::join(reader.next().fields, ",")) != kHeader)
        throwBadInput(where + ":1", fmt::format("the first line must be {}", kHeader));
    while (!reader.done()) {
        const Record record = reader.next();
        if (record.fields.size() == 1 && record.fields[0].empty()) continue; // an empty line
        samples.push_back(readSample(record, where));
    }
    if (samples.empty()) throwBadInput(where, "has no samples");
    return samples;
}

} // namespace isolux
