// SPDX-License-Identifier: Apache-2.0
#include <algorithm>

#include "core/error.hpp"
#include "scenes/compare/dataset_hash.hpp"
#include "scenes/compare/file_content.hpp"
#include "scenes/trajectory/trajectory_layout.hpp"

namespace tesserae::scenes {
namespace {

using hdf5::Handle;

/// Groups inside each other, usual 4: ends a walk around a cycle of hard links.
constexpr int kDeepest = 16;
/// Groups and datasets by all their names, usual 60: ends a walk whose cycles branch.
constexpr std::uint64_t kMostObjects = 10'000;
/// How a file came about, but for its effective text.
constexpr const char* kParameters = "/parameters";
constexpr const char* kEffective = "/parameters/scene/effective";

class Walk {
  public:
    Walk(const std::filesystem::path& path, std::vector<ContentEntry>& entries)
        : file_bytes_(checked_file_bytes(path)),
          file_(hdf5::open_file(path, false)),
          entries_(entries) {}

    void walk() {
        add_group({H5Gopen2(file_.get(), "/", H5P_DEFAULT), H5Gclose}, "", 0);
        add_dataset(hdf5::open_dataset(file_.get(), kEffective), kEffective);
        std::sort(entries_.begin(), entries_.end(),
                  [](const ContentEntry& a, const ContentEntry& b) { return a.name < b.name; });
    }

  private:
    void add_group(const Handle& group, const std::string& path, int depth) {
        if (depth > kDeepest)
            throw hdf5::Failure(fmt::format("its groups are nested deeper than {}", kDeepest));
        for (const std::string& name : hdf5::link_names(group, kMostObjects)) {
            const std::string child = path + "/" + name;
            if (child == kParameters) continue;
            if (++objects_ > kMostObjects)
                throw hdf5::Failure(fmt::format("it holds more than {} objects", kMostObjects));
            const Handle object = hdf5::open_object(group.get(), name);
            const H5I_type_t kind = H5Iget_type(object.get());
            if (kind == H5I_GROUP)
                add_group(object, child, depth + 1);
            else if (kind == H5I_DATASET)
                add_dataset(object, child);
            else
                throw hdf5::Failure(child + ": is neither a group nor a dataset");
        }
    }

    void add_dataset(const Handle& dataset, const std::string& path) {
        DatasetContent content = content_of(dataset, path, file_bytes_);
        bytes_ += content.bytes;
        // Many names for one dataset that gzip made small would take days.
        if (bytes_ > static_cast<double>(kMostCompression) * static_cast<double>(file_bytes_))
            throw hdf5::Failure("its datasets claim to hold more than the file can");
        entries_.push_back({path, std::move(content.description), std::move(content.hash)});
    }

    std::uint64_t file_bytes_;
    Handle file_;
    std::vector<ContentEntry>& entries_;
    std::uint64_t objects_ = 0;
    double bytes_ = 0;
};

}  // namespace

Content trajectory_content(const std::filesystem::path& file) {
    Content content{FileKind::kTrajectory, {}};
    try {
        Walk(file, content.entries).walk();
    } catch (const hdf5::Failure& failure) {
        throw InputError(
            fmt::format("{}: not a readable trajectory: {}", file.string(), failure.what()));
    }
    return content;
}

}  // namespace tesserae::scenes
