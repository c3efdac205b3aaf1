// SPDX-License-Identifier: Apache-2.0
// What a trajectory says of its bodies, read through HDF5's own interface.
#include "scenes/trajectory/body_datasets.hpp"

#include <gtest/gtest.h>

#include <cstring>
#include <limits>
#include <regex>

#include "tests/scenes/program/program.hpp"
#include "tests/scenes/trajectory/datasets.hpp"
#include "tests/scenes/trajectory/trajectory_rows.hpp"

namespace tesserae::scenes {
namespace {

namespace fs = std::filesystem;

class BodyDatasets : public ::testing::Test {
  protected:
    void write(const TrajectoryHeader& header, std::uint64_t rows) const {
        TrajectoryWriter writer(path_, header, make_steps(rows), false);
        append_rows(writer, rows, header.bodies);
        writer.finish();
    }
    std::vector<std::string> texts(const std::string& name) const {
        return texts_of(path_, ("/particles/bodies/" + name).c_str());
    }
    std::string attribute(const std::string& object, const char* name) const {
        const hdf5::Handle file = hdf5::open_file(path_, false);
        const hdf5::Handle dataset = hdf5::open_dataset(file.get(), object);
        return hdf5::read_text_attribute(dataset.get(), name);
    }

    const testing::Folder folder_{"bodies"};
    const fs::path path_ = folder_ / "film.h5";
};

TEST_F(BodyDatasets, SayWhatEveryBodyIs) {
    // From one to several pieces of text.
    for (const std::size_t bodies : {1u, 7u, 50'000u}) {
        fs::remove(path_);
        write(make_header(bodies), 1);
        const auto name = texts("name"), shape = texts("shape"), size = texts("size");
        const std::string bytes = datasets_of(path_).at("particles/bodies/mass");
        ASSERT_EQ(bytes.size(), 8 * bodies);
        std::vector<double> mass(bodies);
        std::memcpy(mass.data(), bytes.data(), bytes.size());
        for (const auto* column : {&name, &shape, &size}) ASSERT_EQ(column->size(), bodies);
        EXPECT_EQ(name[0], "floor");
        EXPECT_EQ(shape[0], "hyperplane");
        EXPECT_EQ(size[0], "normal = [0, 1, 0, 0], offset = -1");
        EXPECT_EQ(mass[0], std::numeric_limits<double>::infinity());
        for (std::size_t i = 1; i < bodies; ++i) {
            const bool is_ball = make_descriptions(bodies).type[i] == 1;
            ASSERT_EQ(name[i], "d\xc3\xa9j\xc3\xa0") << i;
            ASSERT_EQ(shape[i], is_ball ? "hypersphere" : "hyperbox") << i;
            ASSERT_EQ(size[i], is_ball ? "radius = 0.5" : "size = [1, 2, 3, 0.25]") << i;
            ASSERT_EQ(mass[i], is_ball ? 2.5 : 1e-3) << i;
        }
        // Names, shapes and sizes are as wide as the longest in the list of types.
        EXPECT_EQ(description_bytes(make_descriptions(bodies)), 8u + 6 + 11 + 34);
    }
}

TEST_F(BodyDatasets, UnitsAndComponentsAreNamed) {
    write(make_header(2), 1);
    EXPECT_EQ(attribute("/particles/bodies/mass", "unit"), "kg");
    const std::pair<const char*, const char*> components[] = {
        {"/particles/bodies/position/value", "x y z w"},
        {"/particles/bodies/rotor/value", "s xy xz xw yz yw zw xyzw"},
        {"/particles/bodies/velocity/value", "x y z w"},
        {"/particles/bodies/angular_velocity/value", "xy xz xw yz yw zw"},
        {"/observables/momentum/value", "x y z w"},
        {"/observables/angular_momentum/value", "xy xz xw yz yw zw"}};
    for (const auto& [dataset, names] : components)
        EXPECT_EQ(attribute(dataset, "components"), names) << dataset;
    // Those names are those of the members, in the order of memory.
    const Rotor rotor{0, {1, 2, 3, 4, 5, 6}, 7};
    double in_memory[8];
    std::memcpy(in_memory, &rotor, sizeof rotor);
    for (int i = 0; i < 8; ++i) EXPECT_EQ(in_memory[i], i);
    EXPECT_TRUE(rotor.b.xz == 2 && rotor.b.xw == 3 && rotor.b.yz == 4 && rotor.b.yw == 5);
}

TEST_F(BodyDatasets, AHyperplaneIsStoredWithItsNormalMadeUnit) {
    BodyType plane{Hyperplane{{0, 0, 2, 0}, 3}};
    std::visit([](auto& s) { complete(s); }, plane.shape);
    const BodyType capsule{Hypercapsule{0.2, 1}};
    const std::vector<BodyType> types = {plane, capsule};
    const std::vector<std::uint32_t> type = {0, 1};
    const std::vector<NamedBodies> names = {{"a", 0, 1}, {"b", 1, 1}};
    TrajectoryHeader header = make_header(2);
    header.described = {types, type, names};
    write(header, 1);
    EXPECT_EQ(texts("size"), (std::vector<std::string>{"normal = [0, 0, 1, 0], offset = 3",
                                                       "radius = 0.2, height = 1"}));
}

/// A header of bodies that have another name but move in the same way.
TrajectoryHeader renamed(const std::vector<NamedBodies>& names) {
    TrajectoryHeader header = make_header(9);
    header.effective = "[[lattice]]\nname = \"" + names[0].name + "\"\n";
    header.described.names = names;
    return header;
}

TEST_F(BodyDatasets, AContinuedTrajectoryHasTheNamesOfItsScene) {
    const std::vector<NamedBodies> first = {{"a", 0, 9}}, longer = {{"a longer name", 0, 9}};
    for (const auto& [before, after] : {std::pair(first, longer), std::pair(longer, first)}) {
        fs::remove(path_);
        write(renamed(after), 20);
        const auto straight = datasets_of(path_);
        fs::remove(path_);
        write(renamed(before), 10);
        EXPECT_EQ(texts("name"), std::vector<std::string>(9, before[0].name));
        write(renamed(after), 20);
        EXPECT_EQ(datasets_of(path_), straight);
        EXPECT_EQ(texts("name"), std::vector<std::string>(9, after[0].name));
    }
}

TEST_F(BodyDatasets, AFileWithoutThemIsReadAndContinuedWithoutThem) {
    write(make_header(9), 20);
    const auto straight = datasets_of(path_);
    fs::remove(path_);
    write(make_header(9), 10);
    const hid_t file = H5Fopen(path_.c_str(), H5F_ACC_RDWR, H5P_DEFAULT);
    for (const char* name : {"mass", "name", "shape", "size"})
        ASSERT_GE(H5Ldelete(file, (std::string("/particles/bodies/") + name).c_str(), H5P_DEFAULT),
                  0);
    H5Fclose(file);
    write(renamed({{"b", 0, 9}}), 20);
    EXPECT_EQ(TrajectoryReader(path_).rows(), 20u);
    EXPECT_EQ(datasets_of(path_).size() + 4, straight.size());
}

TEST_F(BodyDatasets, TheManualNamesWhatAFileHas) {
    const std::string page = testing::content(TESSERAE_SOURCE_DIR "/scenes/manual/data.md");
    write(make_header(9), 3);
    const auto found = datasets_of(path_);
    const std::regex row(R"(\n\| `(particles/bodies/[a-z_/]+)` \|)");
    int rows = 0;
    for (std::sregex_iterator at(page.begin(), page.end(), row), end; at != end; ++at, ++rows)
        EXPECT_TRUE(found.contains((*at)[1])) << (*at)[1];
    EXPECT_GE(rows, 9);
}

}  // namespace
}  // namespace tesserae::scenes
