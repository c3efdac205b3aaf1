// SPDX-License-Identifier: Apache-2.0
// `tesserae export` as another program meets its files.
#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cstring>
#include <memory>
#include <nlohmann/json.hpp>
#include <set>

#include "render/file/image_pixels.hpp"
#include "tests/scenes/program/program.hpp"

namespace tesserae::scenes::testing {
namespace {

namespace fs = std::filesystem;
using Point = Eigen::Vector3d;

/// One of each shape on a floor, seen by a camera that moves, and turns in 4D.
std::string one_of_each() {
    return R"(
[scene]
name = "each"
[physics]
duration = 0.2
steps_per_second = 60
[camera]
position = [0.3, 2.2, -6, 0.1]
look_at = [0, 0.6, 0, 0]
[[camera.key]]
time = 0
fourth = [0, 0, 0, 1]
position = [0.3, 2.2, -6, 0.1]
[[camera.key]]
time = 0.2
fourth = [0.4, 0.1, 0.2, 1]
position = [0.8, 2.6, -5.5, 0.3]
[render]
size = [96, 72]
samples = 1
frames_per_second = 20
[[light]]
type = "sky"
[[body]]
name = "floor"
shape = "hyperplane"
normal = [0, 1, 0, 0]
offset = 0
[[body]]
name = "ball"
shape = "hypersphere"
radius = 0.6
position = [-2, 0.8, 0, 0.1]
[[body]]
name = "capsule \"of\"\nend_header\nelement vertex 5"
shape = "hypercapsule"
radius = 0.4
height = 0.9
position = [-0.7, 1.2, 0.3, 0.2]
rotation = { xy = 30, yw = 40 }
[[body]]
name = "unseen"
shape = "hypersphere"
radius = 1
visible = false
position = [0, 3, 2, 0]
[[body]]
name = "box"
shape = "hyperbox"
size = [0.8, 0.9, 0.7, 1]
position = [0.5, 0.8, -0.5, 0]
rotation = { xz = 30, xw = 20, yw = 15 }
[[body]]
name = "spherinder ü"
shape = "spherinder"
radius = 0.5
height = 0.8
position = [1.7, 1, 0.4, 0]
rotation = { xy = 50, yw = 25 }
[[body]]
name = "cubinder"
shape = "cubinder"
radius = 0.5
size = [0.7, 0.8]
position = [-1.5, 2.1, 0.6, 0]
rotation = { xz = 40, xw = 30 }
[[body]]
name = "duocylinder"
shape = "duocylinder"
radii = [0.5, 0.5]
position = [0, 2.1, 0.5, 0]
rotation = { xz = 40, yw = 30 }
[[body]]
name = "duoprism"
shape = "duoprism"
polygons = [5, 6]
radii = [0.5, 0.6]
position = [1.4, 2.2, 0.5, 0]
rotation = { xz = 20, yw = 30 }
[[lattice]]
name = "cells"
shape = "polychoron"
regular = "24-cell"
radius = 0.5
count = [3, 1, 1, 1]
spacing = [1.2, 1, 1, 1]
position = [0, 0.7, -1.8, 0.1]
rotation = { xw = 20 }
)";
}

/// A mesh read back from a PLY file, polygons as fans of triangles.
struct Ply {
    std::string header;
    std::vector<Point> vertices;
    std::vector<std::uint32_t> vertex_body;
    struct Triangle {
        Point a, b, c;
        std::uint32_t body;
    };
    std::vector<Triangle> triangles;

    explicit Ply(const std::string& bytes) {
        const std::size_t end = bytes.find("end_header\n") + 11;
        header = bytes.substr(0, end);
        const char* at = bytes.data() + end;
        const auto number = [&]<class T>(T value) {
            std::memcpy(&value, at, sizeof value);
            at += sizeof value;
            return value;
        };
        const auto count = [&](const char* what) {
            return std::stoull(header.substr(header.find(what) + std::strlen(what)));
        };
        for (auto left = count("\nelement vertex "); left > 0; --left) {
            const float x = number(0.f), y = number(0.f), z = number(0.f);
            vertices.push_back({x, y, z});
            vertex_body.push_back(number(0u));
        }
        for (auto left = count("\nelement face "); left > 0; --left) {
            std::vector<int> corners(number(std::uint8_t{0}));
            for (int& c : corners) c = number(0);
            const std::uint32_t body = number(0u);
            for (std::size_t i = 2; i < corners.size(); ++i)
                triangles.push_back({vertices.at(corners[0]), vertices.at(corners[i - 1]),
                                     vertices.at(corners[i]), body});
        }
        EXPECT_EQ(at, bytes.data() + bytes.size());
        runs_ = runs();
    }

    /// Triangles that follow each other and are of one body, and a ball that holds them.
    struct Run {
        std::size_t begin, end;
        Point middle;
        double radius;
    };
    std::vector<Run> runs() const {
        std::vector<Run> runs;
        for (std::size_t begin = 0, end = 0; begin < triangles.size(); begin = end) {
            Point sum = Point::Zero();
            for (; end < triangles.size() && triangles[end].body == triangles[begin].body; ++end)
                sum += triangles[end].a;
            Run run{begin, end, sum / static_cast<double>(end - begin), 0};
            for (std::size_t i = begin; i < end; ++i)
                for (const Point& p : {triangles[i].a, triangles[i].b, triangles[i].c})
                    run.radius = std::max(run.radius, (p - run.middle).norm());
            runs.push_back(run);
        }
        return runs;
    }

    /// The body that a ray meets first, 0 for none.
    std::uint32_t body_along(const Point& from, const Point& way) const {
        double nearest = 1e300;
        std::uint32_t body = 0;
        for (const Run& run : runs_)
            if ((run.middle - from).cross(way.normalized()).norm() <= run.radius * (1 + 1e-9))
                meet(run, from, way, nearest, body);
        return body;
    }

  private:
    void meet(const Run& run, const Point& from, const Point& way, double& nearest,
              std::uint32_t& body) const {
        for (std::size_t i = run.begin; i < run.end; ++i) {
            const Triangle& t = triangles[i];
            // Möller and Trumbore 1997.
            const Point e1 = t.b - t.a, e2 = t.c - t.a, p = way.cross(e2);
            const double determinant = e1.dot(p);
            if (determinant == 0) continue;
            const Point s = from - t.a;
            const double u = s.dot(p) / determinant;
            const Point q = s.cross(e1);
            const double v = way.dot(q) / determinant, distance = e2.dot(q) / determinant;
            if (u < 0 || v < 0 || u + v > 1 || distance <= 0 || distance >= nearest) continue;
            nearest = distance, body = t.body;
        }
    }

    std::vector<Run> runs_;
};

Point point_of(const nlohmann::json& list) {
    return Point(list[0].get<double>(), list[1].get<double>(), list[2].get<double>());
}

/// The channel objectid of a frame, by lines.
std::vector<std::uint32_t> ids_of(const fs::path& exr) {
    const render::ImagePixels image(exr);
    std::vector<std::uint32_t> ids;
    image.for_each_block([&](int, int, const render::PixelPlanes& planes) {
        for (std::size_t c = 0; c < image.channels().size(); ++c) {
            if (image.channels()[c].name != "objectid") continue;
            const std::size_t first = ids.size();
            ids.resize(first + planes[c].size() / 4);
            std::memcpy(ids.data() + first, planes[c].data(), planes[c].size());
        }
    });
    return ids;
}

class ExportProgram : public ::testing::Test {
  protected:
    static void SetUpTestSuite() {
        folder_ = std::make_unique<Folder>("export");
        folder_->write("each.toml", one_of_each());
        ASSERT_EQ(tesserae({"run", file("each.toml"), "-o", file("film")}).status, 0);
    }
    static void TearDownTestSuite() { folder_.reset(); }

    static std::string file(const std::string& name) { return folder_->file(name); }
    static Outcome exported(const std::string& format, const std::string& out,
                            std::vector<std::string> more = {}) {
        std::vector<std::string> words = {
            "export", file("film/trajectory.h5"), "--format", format, "-o", file(out)};
        words.insert(words.end(), more.begin(), more.end());
        return tesserae(words);
    }
    void expect_bytes_of_one_thread(const std::vector<const char*>& counts);

    static inline std::unique_ptr<Folder> folder_;
};
using ExportProgramSlow = ExportProgram;

TEST_F(ExportProgram, AFramesMeshesGiveThePictureOfIdsOfTheRenderer) {
    ASSERT_EQ(exported("ply", "ids").status, 0);
    const auto camera = nlohmann::json::parse(content(*folder_ / "ids/camera.json"));
    const int width = camera["size"][0], height = camera["size"][1];
    for (const int frame : {0, 3}) {
        const Ply ply(content(file("ids/each.000" + std::to_string(frame) + ".ply")));
        const auto ids = ids_of(file("film/frames/each.000" + std::to_string(frame) + ".exr"));
        ASSERT_EQ(ids.size(), static_cast<std::size_t>(width * height));
        const auto& at = camera["frames"][frame];
        const Point eye = point_of(at["position"]), right = point_of(at["right"]),
                    forward = point_of(at["forward"]), up = point_of(at["up"]);
        EXPECT_NEAR((right.cross(forward) - up).norm(), 0, 1e-12);
        const double pixel = 2 * std::tan(at["field_of_view"].get<double>() * M_PI / 360) / height;
        int interior = 0, different = 0;
        for (int y = 1; y + 1 < height; ++y)
            for (int x = 1; x + 1 < width; ++x) {
                const std::uint32_t id = ids[y * width + x];
                bool is_interior = true;
                for (int k = 0; k < 9; ++k)
                    is_interior &= ids[(y + k / 3 - 1) * width + x + k % 3 - 1] == id;
                if (!is_interior) continue;
                ++interior;
                const Point way = (x + 0.5 - 0.5 * width) * pixel * right +
                                  (0.5 * height - y - 0.5) * pixel * up + forward;
                different += ply.body_along(eye, way) != id;
            }
        EXPECT_GT(interior, width * height / 2);
        EXPECT_LE(different, interior / 200) << "frame " << frame << " of " << interior;
    }
}

void ExportProgram::expect_bytes_of_one_thread(const std::vector<const char*>& counts) {
    for (const char* format : {"ply", "vtk"}) {
        const std::string one = std::string(format) + "1";
        ASSERT_EQ(exported(format, one, {"--threads", "1"}).status, 0);
        const auto files = files_below(file(one));
        EXPECT_EQ(files.size(), std::string(format) == "ply" ? 5u : 6u);
        for (const char* threads : counts) {
            const std::string out = format + std::string(threads);
            // In two parts.
            ASSERT_EQ(exported(format, out, {"--threads", threads, "--frames", "2"}).status, 0);
            const Outcome rest = exported(format, out, {"--threads", threads, "--json"});
            ASSERT_EQ(rest.status, 0) << rest.err;
            EXPECT_EQ(nlohmann::json::parse(rest.out)["kept"], 1);
            EXPECT_EQ(nlohmann::json::parse(rest.out)["written"], 3);
            EXPECT_EQ(files_below(file(out)), files);
            for (const std::string& name : files)
                EXPECT_EQ(content(file(out + "/" + name)), content(file(one + "/" + name))) << name;
        }
    }
}

TEST_F(ExportProgram, ThreadsAndInterruptionsDoNotChangeBytes) {
    expect_bytes_of_one_thread({"3"});
}
TEST_F(ExportProgramSlow, ThreadsAndInterruptionsDoNotChangeBytes) {
    expect_bytes_of_one_thread({"2", "4"});
}

TEST_F(ExportProgram, NamesAndIdsAreKeptAndNamesBreakNoHeader) {
    ASSERT_EQ(exported("ply", "names").status, 0);
    const Ply ply(content(file("names/each.0000.ply")));
    for (const char* line :
         {"\ncomment body 1 \"floor\"\n", "\ncomment body 2 \"ball\"\n",
          "\ncomment body 3 \"capsule \\\"of\\\"\\nend_header\\nelement vertex 5\"\n",
          "\ncomment body 6 \"spherinder \\u00fc\"\n", "\ncomment body 10-12 \"cells\"\n"})
        EXPECT_NE(ply.header.find(line), std::string::npos) << line << ply.header;
    EXPECT_EQ(ply.header.find("unseen"), std::string::npos);
    std::set<std::uint32_t> of_vertices(ply.vertex_body.begin(), ply.vertex_body.end()), of_faces;
    for (const auto& t : ply.triangles) of_faces.insert(t.body);
    EXPECT_EQ(of_vertices, of_faces);
    EXPECT_EQ(of_faces, (std::set<std::uint32_t>{1, 2, 3, 5, 6, 7, 8, 9, 10, 11, 12}));
}

/// Bytes of a base64 text.
std::string decoded(const std::string& text) {
    const std::string digits = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    std::string bytes;
    unsigned bits = 0, count = 0;
    for (const char c : text) {
        if (c == '=') break;
        bits = bits << 6 | static_cast<unsigned>(digits.find(c)), count += 6;
        if (count >= 8) bytes += static_cast<char>(bits >> (count -= 8) & 255);
    }
    return bytes;
}

/// The numbers of a data array in a .vtp file, after the length that VTK wants before them.
template <class T>
std::vector<T> array_in(const std::string& xml, const std::string& name) {
    const std::size_t begin = xml.find('>', xml.find("Name=\"" + name + "\"")) + 1;
    const std::string bytes = decoded(xml.substr(begin, xml.find('<', begin) - begin));
    std::uint64_t length = 0;
    std::memcpy(&length, bytes.data(), 8);
    EXPECT_EQ(length + 8, bytes.size()) << name;
    std::vector<T> numbers(length / sizeof(T));
    std::memcpy(numbers.data(), bytes.data() + 8, length);
    return numbers;
}

TEST_F(ExportProgram, VtkFilesHoldWhatPlyFilesHold) {
    ASSERT_EQ(exported("ply", "as_ply", {"--frames", "1"}).status, 0);
    ASSERT_EQ(exported("vtk", "as_vtk", {"--frames", "1,3"}).status, 0);
    const Ply ply(content(file("as_ply/each.0001.ply")));
    const std::string xml = content(file("as_vtk/each.0001.vtp"));
    const auto points = array_in<float>(xml, "Points");
    ASSERT_EQ(points.size(), 3 * ply.vertices.size());
    for (std::size_t i = 0; i < points.size(); ++i)
        EXPECT_EQ(points[i], ply.vertices[i / 3][static_cast<int>(i % 3)]);
    const auto body = array_in<std::uint32_t>(xml, "body");
    const auto offsets = array_in<std::int32_t>(xml, "offsets");
    const auto corners = array_in<std::int32_t>(xml, "connectivity");
    ASSERT_EQ(body.size(), offsets.size());
    std::size_t triangle = 0;
    for (std::size_t f = 0, begin = 0; f < offsets.size(); begin = offsets[f++])
        for (std::size_t i = begin + 2; i < static_cast<std::size_t>(offsets[f]); ++i, ++triangle) {
            ASSERT_EQ(ply.triangles.at(triangle).body, body[f]);
            ASSERT_EQ(ply.triangles[triangle].c, ply.vertices.at(corners[i]));
        }
    EXPECT_EQ(triangle, ply.triangles.size());
    EXPECT_NE(xml.find("Name=\"TimeValue\" NumberOfTuples=\"1\" format=\"ascii\">0.05<"),
              std::string::npos);
    // The first name, as numbers of its letters.
    EXPECT_NE(xml.find(">102 108 111 111 114 0 98 97 108 108 0 "), std::string::npos);
    const std::string list = content(file("as_vtk/each.pvd"));
    EXPECT_NE(list.find("<DataSet timestep=\"0.05\" file=\"each.0001.vtp\"/>\n<DataSet "
                        "timestep=\"0.15\" file=\"each.0003.vtp\"/>\n</Coll"),
              std::string::npos)
        << list;
}

TEST_F(ExportProgram, RefusesWhatItCannotDoRight) {
    const auto expect = [](const Outcome& outcome, int status, const std::string& text) {
        EXPECT_EQ(outcome.status, status) << outcome.err;
        EXPECT_NE(outcome.err.find(text), std::string::npos) << outcome.err;
    };
    expect(exported("stl", "bad"), 2, "--format");
    expect(exported("ply", "bad", {"--tolerance", "0"}), 2, "--tolerance");
    expect(exported("ply", "bad", {"--tolerance", "1e-9"}), 2, "--tolerance");
    expect(exported("ply", "bad", {"--frames", "7"}), 2, "frame 7");
    expect(exported("ply", "bad", {"--set", "physics.gravity=[0,-1,0,0]"}), 2, "another motion");
    expect(tesserae({"export", file("each.toml"), "--format", "ply", "-o", file("bad")}), 2,
           "trajectory");
    ASSERT_EQ(exported("ply", "mixed", {"--frames", "0"}).status, 0);
    expect(exported("ply", "mixed", {"--tolerance", "0.1"}), 2, "--overwrite");
    EXPECT_EQ(exported("ply", "mixed", {"--tolerance", "0.1", "--overwrite"}).status, 0);
    EXPECT_EQ(exported("ply", "mixed", {"--tolerance", "0.1"}).status, 0);
    // What cannot be read is not taken for another scene's: a folder can be opened, and not read.
    fs::create_directories(file("unread/each.0000.ply"));
    expect(exported("ply", "unread", {"--frames", "0"}), 2, "cannot be read: Is a directory");
    folder_->write("not_a_folder", "x");
    expect(exported("ply", "not_a_folder"), 1, "not_a_folder");
}

}  // namespace
}  // namespace tesserae::scenes::testing
