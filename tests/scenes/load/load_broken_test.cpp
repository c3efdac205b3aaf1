// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>
#include <sys/stat.h>

#include "tests/scenes/load/load_scene_text.hpp"

namespace tesserae::scenes {
namespace {

struct Broken {
    const char* text;
    const char* place;  ///< line:column, or empty for the whole file
    std::vector<const char*> words;
};

/// Lines and columns are counted by hand: column 1 is a line's first character, a value's place is
/// its own first character, a missing key's that of its table's header. Where a text is not TOML it
/// is where the parser saw that.
const std::vector<Broken>& broken_scenes() {
    static const std::vector<Broken> kScenes = {
        // Not TOML.
        {"hello", "1:6", {"not valid TOML"}},
        {"[physics\nseed = 1\n", "1:9", {"not valid TOML"}},
        {"[physics]\nseed = \n", "2:8", {"not valid TOML"}},
        {"[physics]\nseed = 1\nseed = 2\n", "3:8", {"not valid TOML", "redefine", "seed"}},
        {"[physics]\n[physics]\n", "2:1", {"not valid TOML", "redefine"}},
        {"[scene]\nname = \"a\n", "2:10", {"not valid TOML"}},
        {"[scene]\nname = \"\xff\"\n", "2:8", {"not valid TOML", "invalid utf-8"}},
        {"[physics]\nseed = 99999999999999999999\n", "2:28", {"not valid TOML"}},
        {"[[body]]\nshape = \"hypersphere\"\nradius = 1\n\n[[body]]\nshape = oops\n",
         "6:9",
         {"not valid TOML"}},
        // Unknown tables and keys.
        {"[phsyics]\n",
         "1:2",
         {"scene file: phsyics = ", "unknown table", "did you mean \"physics\"?"}},
        {"gravity = 3\n", "1:1", {"gravity = 3", "unknown key"}},
        {"[physics]\nitertions = 3\n",
         "2:1",
         {"[physics]: itertions = 3", "unknown key", "did you mean \"iterations\"?"}},
        {"[physics]\nstpes_per_second = 3\n", "2:1", {"did you mean \"steps_per_second\"?"}},
        {"[camera]\nfourht = [0, 0, 0, 1]\n", "2:1", {"did you mean \"fourth\"?"}},
        {"[[body]]\nshpae = \"hypersphere\"\nradius = 1\n",
         "2:1",
         {"body 0: shpae = \"hypersphere\"", "did you mean \"shape\"?"}},
        {"[[body]]\nshape = \"hypersphere\"\nradius = 1\nheight = 2\n",
         "4:1",
         {"body 0: height = 2", "unknown key"}},
        {"[[body]]\nname = \"x\"\nshape = \"hypersphere\"\nradius = 1\nrotation = { yx = 3 }\n",
         "5:14",
         {"body 0 \"x\": rotation: yx = 3", "did you mean \"xy\"?"}},
        {"[physics]\nzzz = 1\n", "2:1", {"known here: gravity duration"}},
        // Wrong kinds of tables.
        {"[[physics]]\n", "1:1", {"expected one table, [physics]"}},
        {"physics = 3\n", "1:11", {"physics = 3", "expected one table"}},
        {"[body]\n", "1:1", {"expected an array of tables, [[body]]"}},
        {"material = [1]\n", "1:13", {"expected an array of tables, [[material]]"}},
        // Wrong types and ranges.
        {"[render]\npreview_size = 0\n",
         "2:16",
         {"[render]: preview_size = 0", "expected an integer from 1"}},
        {"[render]\npreview_size = \"big\"\n", "2:16", {"wrong type", "an integer from 1"}},
        {"[render]\nsize = [640, 360]\npreview_size = 641\n",
         "3:16",
         {"preview_size = 641", "from 1 to 640, the frame's width", "or set size"}},
        {"[physics]\nduration = \"2\"\n",
         "2:12",
         {"[physics]: duration = \"2\"", "wrong type", "number >= 0"}},
        {"[physics]\nduration = -1\n", "2:12", {"duration = -1", ">= 0"}},
        {"[physics]\nduration = nan\n", "2:12", {"duration = nan"}},
        {"[physics]\nduration = inf\n", "2:12", {"duration = inf", "finite"}},
        {"[physics]\nduration = 1e16\n", "2:12", {"duration = 1e+16", "at most 1e+15"}},
        {"[physics]\nsteps_per_second = 0\n", "2:20", {"steps_per_second = 0", "> 0"}},
        {"[physics]\niterations = 0\n", "2:14", {"iterations = 0", "integer from 1 to 10000"}},
        {"[physics]\ntolerance = -1e-6\n", "2:13", {"tolerance = -1e-06", ">= 0"}},
        {"[physics]\ntolerance = inf\n", "2:13", {"tolerance = inf", "finite"}},
        {"[physics]\ntolerance = \"small\"\n", "2:13", {"tolerance", "wrong type", "number"}},
        {"[physics]\ntolerence = 0\n", "2:1", {"did you mean \"tolerance\"?"}},
        {"[physics]\niterations = 10.0\n", "2:14", {"iterations = 10", "wrong type", "integer"}},
        {"[physics]\nseed = -1\n", "2:8", {"seed = -1", "integer >= 0"}},
        {"[physics]\ngravity = [0, -10, 0]\n", "2:11", {"has 3 values", "array of 4 numbers"}},
        {"[physics]\ngravity = [0, -10,\n 0, inf]\n", "3:5", {"gravity[3] = inf", "finite"}},
        {"[physics]\ngravity = -10\n", "2:11", {"wrong type", "array of 4 numbers"}},
        {"[physics]\nintegrator = \"eular\"\n", "2:14", {"did you mean \"euler\"?"}},
        {"[physics]\nsleeping = 1\n", "2:12", {"true or false"}},
        {"[physics]\nsolver = \"sofd\"\n", "2:10", {"solver = \"sofd\"", "expected \"impulse\""}},
        {"[physics]\nsolver = \"soft\"\n", "2:10", {"solver = \"soft\"", "remove the key"}},
        {"[physics]\nsolver = true\n", "2:10", {"wrong type"}},
        {"[physics]\nsubsteps = 0\n", "2:12", {"substeps = 0", "1 to 1000"}},
        {"[physics]\nsubsteps = 1001\n", "2:12", {"substeps = 1001", "1 to 1000"}},
        {"[physics]\nsubsteps = 2.5\n", "2:12", {"wrong type"}},
        {"[scene]\nname = \"../../x\"\n", "2:8", {"[scene]: name = \"../../x\"", "1 to 64"}},
        {"[scene]\nname = \"\"\n", "2:8", {"1 to 64"}},
        {"[scene]\nname = 1979-05-27\n", "2:8", {"wrong type", "string"}},
        // Materials.
        {"[[material]]\nalbedo = [0, 0, 0]\n", "1:1", {"material 0: name is missing"}},
        {"[[material]]\nname = \"a\"\n[[material]]\nname = \"a\"\n",
         "4:8",
         {"material 1: name = \"a\"", "material 0 already"}},
        {"[[material]]\nname = \"a\"\nalbedo = [0, 1.5, 0]\n",
         "3:14",
         {"albedo[1] = 1.5", ">= 0 and <= 1"}},
        {"[[material]]\nname = \"a\"\npattern = \"cheker\"\n",
         "3:11",
         {"did you mean \"checker\"?"}},
        {"[[material]]\nname = \"a\"\npattern_size = 0\n", "3:16", {"> 0"}},
        {"[[material]]\nname = \"a\"\npattern = \"edge\"\n", "3:11", {"did you mean \"edges\"?"}},
        {"[[material]]\nname = \"a\"\nline_width = 0\n", "3:14", {"line_width = 0", "> 0"}},
        {"[[material]]\nname = \"a\"\nw_of = \"centre\"\n", "3:8", {"point", "body"}},
        {"[render]\nghost_depth = -1\n", "2:15", {"ghost_depth = -1", ">= 0"}},
        {"[render]\nghosts = \"under\"\n", "2:10", {"layer", "over"}},
        {"[render]\nghost_plus = [2, 0, 0]\n", "2:15", {"ghost_plus[0] = 2", "<= 1"}},
        {"[overlay]\ntime = 1\n", "2:8", {"wrong type"}},
        {"[overlay]\ntitle = \"a\\nb\"\n", "2:9", {"one line"}},
        {"[overlay]\ntext_size = 2\n", "2:13", {"text_size = 2", "<= 1"}},
        {"[[overlay.caption]]\nfrom = 1\n", "1:1", {"text is missing"}},
        {"[[overlay.caption]]\ntext = \"a\"\nfrom = 2\nto = 1\n", "4:6", {"from < to"}},
        // Shapes.
        {"[[body]]\n", "1:1", {"body 0: shape is missing", "hypersphere", "hyperplane"}},
        {"[[body]]\nshape = \"hypershpere\"\nradius = 1\n",
         "2:9",
         {"did you mean \"hypersphere\"?"}},
        {"[[body]]\nshape = \"hypersphere\"\n", "1:1", {"body 0: radius is missing"}},
        {"[[body]]\nshape = \"hypersphere\"\nradius = -0.5\n", "3:10", {"radius = -0.5", "> 0"}},
        {"[[body]]\nshape = \"hypersphere\"\nradius = 1e-20\n", "3:10", {"at least 1e-15"}},
        {"[[body]]\nshape = \"hypercapsule\"\nradius = 1\nheight = -1\n", "4:10", {"height = -1"}},
        {"[[body]]\nshape = \"hypercapsule\"\nradius = 1\n", "1:1", {"height is missing"}},
        {"[[body]]\nshape = \"hyperbox\"\nsize = [1, 1, -0.5, 1]\n", "3:15", {"size[2] = -0.5"}},
        {"[[body]]\nshape = \"hyperplane\"\nnormal = [0, 0, 0, 0]\n",
         "3:10",
         {"normal = [0, 0, 0, 0]", "direction, not zero"}},
        {"[[body]]\nshape = \"hyperplane\"\nnormal = [0, 1, 0, 0]\nposition = [0, 0, 0, 0]\n",
         "4:12",
         {"a hyperplane never moves and has no position"}},
        {"[[body]]\nshape = \"hyperplane\"\nnormal = [0, 1, 0, 0]\nmass = 1\n",
         "4:8",
         {"has no mass"}},
        {"[[body]]\nshape = \"hyperplane\"\nnormal = [0, 1, 0, 0]\nvelocity = [0, 0, 0, 0]\n",
         "4:12",
         {"has no velocity"}},
        // Bodies.
        {"[[body]]\nshape = \"hypersphere\"\nradius = 1\nmass = 1\ndensity = 1\n",
         "5:11",
         {"density = 1", "only one"}},
        {"[[body]]\nshape = \"hypersphere\"\nradius = 1\nmass = 0\n", "4:8", {"mass = 0"}},
        {"[[body]]\nshape = \"hypersphere\"\nradius = 1e15\ndensity = 1e15\n",
         "2:9",
         {"radius = 1e+15", "density = 1e+15", "the mass would be"}},
        {"[[body]]\nshape = \"hypersphere\"\nradius = 1e-15\ndensity = 1e-15\n",
         "2:9",
         {"radius = 1e-15", "the mass would be"}},
        {"[[body]]\nshape = \"hypersphere\"\nradius = 1\nrolling_friction = -0.01\n",
         "4:20",
         {"rolling_friction = -0.01", ">= 0"}},
        {"[[body]]\nshape = \"hypersphere\"\nradius = 1\nrolling_friction = inf\n",
         "4:20",
         {"rolling_friction = inf", "finite"}},
        {"[[body]]\nshape = \"hypersphere\"\nradius = 1\nrolling_fricton = 0.1\n",
         "4:1",
         {"rolling_friction"}},
        {"[[body]]\nshape = \"hypersphere\"\nradius = 1\nrestitution = 1.1\n",
         "4:15",
         {">= 0 and <= 1"}},
        {"[[body]]\nshape = \"hypersphere\"\nradius = 1\nfixed = [\"positon\"]\n",
         "4:10",
         {"fixed[0] = \"positon\"", "did you mean \"position\"?"}},
        {"[[body]]\nshape = \"hypersphere\"\nradius = 1\nfixed = \"position\"\n",
         "4:9",
         {"an array of"}},
        {"[[material]]\nname = \"red\"\n[[body]]\nshape = \"hypersphere\"\nradius = 1\n"
         "material = \"rde\"\n",
         "6:12",
         {"material = \"rde\"", "did you mean \"red\"?"}},
        {"[[body]]\nname = \"a\"\nshape = \"hypersphere\"\nradius = 1\n"
         "[[body]]\nname = \"a\"\nshape = \"hypersphere\"\nradius = 1\n",
         "6:8",
         {"body 1 \"a\": name = \"a\"", "has this name"}},
        {"[[body]]\nname = \"body-1\"\nshape = \"hypersphere\"\nradius = 1\n"
         "[[body]]\nshape = \"hypersphere\"\nradius = 1\n",
         "5:1",
         {"body 1: another body is called \"body-1\"", "give it a name"}},
        {"[[body]]\nname = 3\nshape = \"hypersphere\"\nradius = 1\n", "2:8", {"body 0: name = 3"}},
        {"[[body]]\nshape = \"hypersphere\"\nradius = 1\n[physics]\n[body.rotation]\nxy = 1\n",
         "5:1",
         {"right after"}},
        // Lattices.
        {"[[lattice]]\nshape = \"hypersphere\"\nradius = 1\nspacing = 1\n",
         "1:1",
         {"lattice 0: count is missing"}},
        {"[[lattice]]\nshape = \"hypersphere\"\nradius = 1\ncount = [1, 1, 1, 1]\n",
         "1:1",
         {"spacing is missing"}},
        {"[[lattice]]\nshape = \"hypersphere\"\nradius = 1\nspacing = 1\n"
         "count = [1000, 1000, 1000, 1000]\n",
         "5:9",
         {"too many bodies", "10000000"}},
        {"[[lattice]]\nshape = \"hypersphere\"\nradius = 1\nspacing = 1\n"
         "count = [4294967296, 4294967296, 1, 1]\n",
         "5:9",
         {"too many bodies"}},
        {"[[lattice]]\nshape = \"hypersphere\"\nradius = 1\nspacing = 1\ncount = [1, 0, 1, 1]\n",
         "5:13",
         {"count[1] = 0", ">= 1"}},
        {"[[lattice]]\nshape = \"hyperplane\"\nnormal = [0, 1, 0, 0]\nspacing = 1\n"
         "count = [1, 1, 1, 1]\n",
         "2:9",
         {"cannot be in a lattice"}},
        // The camera.
        {"[camera]\nposition = [0, 0, 0, 0]\n", "2:12", {"position and look_at must differ"}},
        {"[camera]\nfourth = [0, -2, 8, 0]\n", "2:10", {"parallel to the forward direction"}},
        {"[camera]\nup = [0, -2, 8, 3]\n", "2:6", {"lies in the plane"}},
        {"[camera]\nup = [0, 0, 0, 0]\n", "2:6", {"direction, not zero"}},
        {"[camera]\nfield_of_view = 180\n", "2:17", {"> 0 and < 180"}},
        // Lights.
        {"[[light]]\n", "1:1", {"light 0: type is missing"}},
        {"[[light]]\ntype = \"sum\"\n", "2:8", {"did you mean \"sun\"?"}},
        {"[[light]]\ntype = \"sun\"\n", "1:1", {"direction is missing"}},
        {"[[light]]\ntype = \"sky\"\nangle = 3\n", "3:1", {"angle = 3", "unknown key"}},
        {"[[light]]\ntype = \"sun\"\ndirection = [0, -1, 0, 0]\nangle = 31\n",
         "4:9",
         {">= 0 and <= 30"}},
        {"[[light]]\ntype = \"sky\"\nstrength = -1\n", "3:12", {"strength = -1", ">= 0"}},
        {"[[body]]\nshape = \"polychoron\"\n", "1:1", {"regular is missing", "vertices"}},
        {"[[body]]\nshape = \"polychoron\"\nregular = \"24cell\"\nradius = 1\n",
         "3:11",
         {"did you mean \"24-cell\"?"}},
        {"[[body]]\nshape = \"polychoron\"\nregular = \"5-cell\"\n", "1:1", {"radius is missing"}},
        {"[[body]]\nshape = \"polychoron\"\nregular = \"5-cell\"\nvertices = [[0, 0, 0, 0]]\n",
         "3:11",
         {"there are vertices too"}},
        {"[[body]]\nshape = \"polychoron\"\nvertices = [[0, 0, 0, 0]]\n",
         "3:12",
         {"1 different points", "at least 5"}},
        {"[[body]]\nshape = \"polychoron\"\nvertices = [[0, 0, 0]]\n", "3:13", {"4 numbers"}},
        {"[[body]]\nshape = \"polychoron\"\nvertices = [[0,0,0,0],[1,0,0,0],[0,1,0,0],[0,0,1,0],"
         "[1,1,1,0],[2,1,1,0]]\n",
         "3:12",
         {"three-dimensional space"}},
        // The picture.
        {"[render]\nsize = [0, 3]\n", "2:9", {"size[0] = 0", "1 to 65536"}},
        {"[render]\nsize = 3\n", "2:8", {"array of 2 integers"}},
        {"[render]\nsamples = 1048577\n", "2:11", {"1 to 1048576"}},
        {"[render]\ntile = 7\n", "2:8", {"8 to 512"}},
        {"[render]\nchannels = [\"colour\"]\n", "2:13", {"did you mean \"color\"?"}},
        {"[render]\nchannels = [\"id\", \"id\"]\n", "2:19", {"channels[1] = \"id\"", "twice"}},
        {"[render]\nsky = \"clear\"\n", "2:7", {"\"opaque\"", "\"transparent\""}},
        {"[render]\nchannels = []\n", "2:12", {"at least one"}},
        {"[render]\nintegrator = \"euler\"\n", "2:14", {"\"direct\"", "\"path\""}},
        {"[render]\nbounces = 1000001\n", "2:11", {"0 to 1000000"}},
        {"[render]\nbounces = -1\n", "2:11", {"bounces = -1"}},
        {"[render]\nspecular_bounces = 1000001\n", "2:20", {"0 to 1000000"}},
        {"[render]\nspecular_bounces = -1\n", "2:20", {"specular_bounces = -1"}},
        {"[[material]]\nname = \"a\"\nkind = \"glas\"\n", "3:8", {"did you mean \"glass\"?"}},
        {"[[material]]\nname = \"a\"\nroughness = 1.5\n", "3:13", {">= 0 and <= 1"}},
        {"[[material]]\nname = \"a\"\nemission = [1, -1, 1]\n", "3:16", {"emission[1] = -1"}},
        {"[[light]]\ntype = \"point\"\n", "1:1", {"position is missing"}},
        {"[[light]]\ntype = \"point\"\nposition = [0, 1, 0, 0]\nradius = 1\n",
         "4:1",
         {"radius = 1", "unknown key"}},
        {"[[light]]\ntype = \"sphere\"\nposition = [0, 1, 0, 0]\n", "1:1", {"radius is missing"}},
        {"[[light]]\ntype = \"sphere\"\nposition = [0, 1, 0, 0]\nradius = 0\n",
         "4:10",
         {"radius = 0"}},
        {"[[material]]\nname = \"a\"\nior = 1\n", "3:7", {"> 1"}},
        {"[camera]\naperture = -0.1\n", "2:12", {"aperture = -0.1", ">= 0"}},
        {"[camera]\nshutter = 1.5\n", "2:11", {"shutter = 1.5"}},
        {"[camera]\nslices = 4\n", "2:10", {"slice_thickness"}},
        {"[camera]\nslices = 1001\nslice_thickness = 1\n", "2:10", {"1 to 1000"}},
        {"[camera]\n[[camera.key]]\nup = [0, 1, 0, 0]\n", "2:1", {"time is missing"}},
        {"[camera]\n[[camera.key]]\ntime = 1\n", "2:1", {"expected position, look_at, up"}},
        {"[camera]\n[[camera.key]]\ntime = 1\nup = [0, 1, 0, 0]\n"
         "[[camera.key]]\ntime = 1\nup = [0, 1, 0, 0]\n",
         "6:8",
         {"after the last key's, 1 s"}},
        {"[camera]\n[[camera.key]]\ntime = 1\nup = [0, 1, 0, 0]\n"
         "[[camera.key]]\ntime = 2\nup = [0, -2, 0, 0]\n",
         "7:6",
         {"opposite to the last key's"}},
        {"[[camera.key]]\ntime = 1\norbit = 90\n", "3:9", {"orbit = 90", "a table such as {"}},
        {"[[camera.key]]\ntime = 1\norbit = { plane = \"xz\", angle = 90 }\n",
         "3:9",
         {"orbit: about is missing"}},
        {"[[camera.key]]\ntime = 1\norbit = { about = [0, 0, 0, 0], plane = \"zx\", angle = 90 }\n",
         "3:41",
         {"plane = \"zx\"", "\"xz\""}},
        {"[[camera.key]]\ntime = 1\n"
         "orbit = { about = [0, 0, 0, 0], plane = \"xz\", angle = 400000 }\n",
         "3:55",
         {"angle = 400000", "360000"}},
        {"[[camera.key]]\ntime = 1\n"
         "orbit = { about = [0, 0, 0, 0], plane = \"xz\", angel = 90 }\n",
         "3:47",
         {"did you mean \"angle\"?"}},
        {"[[camera.key]]\ntime = 1\nposition = [0, 0, -5, 0]\n"
         "orbit = { about = [0, 0, 0, 0], plane = \"xz\", angle = 90 }\n",
         "4:9",
         {"there is a position too", "only one of them"}},
        {"[[camera.key]]\ntime = 0\norbit = { about = [0, 0, 0, 0], plane = \"xz\", angle = 90 }\n",
         "2:8",
         {"takes the time from 0 s", "a key before it"}},
        {"[[camera.key]]\ntime = 1\norbit = { about = [0, 2, 0, 0], plane = \"xw\", angle = 90 }\n",
         "3:9",
         {"on the axis", "[0, 2, -8, 0]", "an about beside it"}},
        {"[render]\nfilter = \"gausian\"\n", "2:10", {"did you mean \"gaussian\"?"}},
        {"[render]\nfilter_width = 0\n", "2:16", {"filter_width = 0"}},
        {"[render]\nmax_distance = -1\n", "2:16", {"max_distance = -1"}},
        {"[render]\nnoise_target = -1\n", "2:16", {"noise_target = -1"}},
        {"[render]\ncompression = \"dwaa\"\n", "2:15", {"\"zip\"", "\"piz\""}},
        {"[render]\nmax_samples = 0\n", "2:15", {"1 to 1048576"}},
        {"[render]\nseed = -1\n", "2:8", {"seed = -1", "an integer >= 0"}},
        {"[render]\nlock_noise = 1\n", "2:14", {"lock_noise = 1"}},
    };
    return kScenes;
}

TEST(BrokenScene, SaysWhereAndWhat) {
    for (const Broken& scene : broken_scenes()) {
        const std::string message = error_of(scene.text);
        EXPECT_TRUE(message.starts_with(fmt::format("test.toml:{}: ", scene.place)))
            << "expected " << scene.place << ", got: " << message << "\nfor:\n"
            << scene.text;
        for (const char* word : scene.words)
            EXPECT_NE(message.find(word), std::string::npos)
                << "expected: " << word << "\ngot: " << message << "\nfor:\n"
                << scene.text;
        EXPECT_EQ(message.find('\n'), std::string::npos) << message;
        EXPECT_LT(message.size(), 600U) << message;
    }
}

TEST(BrokenScene, ValuesAreCutAndEscaped) {
    const std::string name = "\\u001b[31m" + std::string(5000, 'x');
    const std::string message = error_of("[scene]\nname = \"" + name + "\"\n");
    EXPECT_LT(message.size(), 300U);
    EXPECT_EQ(message.find('\x1b'), std::string::npos);
    EXPECT_NE(message.find("\\u001B[31mxxx"), std::string::npos) << message;
}

TEST(BrokenScene, FilesThatAreNone) {
    const SceneFile file("");
    const auto message = [](const std::filesystem::path& path) {
        try {
            load_scene(path, {});
        } catch (const InputError& error) {
            return std::string(error.what());
        }
        return std::string();
    };
    const auto missing = file.folder() / "missing.toml", fifo = file.folder() / "fifo";
    ASSERT_EQ(::mkfifo(fifo.c_str(), 0600), 0);
    EXPECT_EQ(message(missing), missing.string() + ": cannot be read: No such file or directory");
    EXPECT_EQ(message(file.folder()),
              file.folder().string() + ": is a folder; expected a scene file (TOML)");
    EXPECT_EQ(message(fifo), fifo.string() + ": is not a regular file; expected a scene file");
    EXPECT_EQ(message("/dev/zero"), "/dev/zero: is not a regular file; expected a scene file");
    if (::geteuid() != 0) {
        std::filesystem::permissions(file.path(), std::filesystem::perms::none);
        EXPECT_EQ(message(file.path()),
                  file.path().string() + ": cannot be read: Permission denied");
    }
}

TEST(BrokenScene, TextThatIsNone) {
    EXPECT_EQ(error_of(std::string_view("\x7f"
                                        "ELF\0\1",
                                        6)),
              "test.toml: is not text: byte 4 is zero; expected a scene file (TOML)");
    EXPECT_EQ(error_of(std::string_view("\xff\xfe[\0", 4)),
              "test.toml: is UTF-16 text; save it as UTF-8");
}

TEST(BrokenScene, TextWithoutTables) {
    for (const char* text : {"", "\n", "\xef\xbb\xbf", " \t\r\n# a scene\n"})
        EXPECT_EQ(error_of(text),
                  "test.toml: is empty; expected tables such as [[body]], [camera] and [render]")
            << text;
}

TEST(BrokenScene, TooLargeIsSeenBeforeReading) {
    const SceneFile file("");
    std::filesystem::resize_file(file.path(), 256'000'001);  // sparse
    EXPECT_THROW(load_scene(file.path(), {}), InputError);
}

}  // namespace
}  // namespace tesserae::scenes
