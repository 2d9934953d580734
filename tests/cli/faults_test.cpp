// Disks that fill up, memory that ends, outputs that are inputs, standard streams that are closed:
// no fault leaves with code 0, half a file or without the file that was there before.
#include <gtest/gtest.h>
#include <signal.h>
#include <sys/stat.h>

#include <algorithm>
#include <chrono>
#include <filesystem>
#include <fstream>
#include <map>
#include <nlohmann/json.hpp>
#include <thread>

#include "cli/process.h"

namespace mv {
namespace {

namespace fs = std::filesystem;
using test::ProcessResult;
using test::Sandbox;
using test::smallPicture;
using Arguments = std::vector<std::string>;

constexpr const char* kOld = "what was here before\n";

// ---------------------------------------------------------------- full disks

// One run that writes every kind of file, and those files.
struct Run {
    friend std::ostream& operator<<(std::ostream& out, const Run& run) { return out << run.name; }
    const char* name;
    const char* program;
    Arguments arguments;
    Arguments outputs;
};

const std::vector<Run>& runs() {
    static const std::vector<Run> all = {
        {"headless",
         "megaviews",
         smallPicture({"-o", "a.png", "-o", "a.exr", "--save-views", "v.ply", "--save-maps",
                       "m.npy", "--save-scene", "g.glb", "--save-state", "t.json", "--stats",
                       "s.json", "--reference", "reference.exr", "--diff", "d.png"}),
         {"a.png", "a.exr", "v.ply", "m.npy", "m.centres.npy", "m.views.npy", "g.glb", "t.json",
          "s.json", "d.png"}},
        {"script",
         "megaviews",
         smallPicture(
             {"--actions", "save a.png; save-window w.png; save-state t.json; save-scene g.glb"}),
         {"a.png", "w.png", "t.json", "g.glb"}},
        {"compare",
         "megaviews-bench",
         {"compare", "x.npy", "x.npy", "--json", "c.json"},
         {"c.json"}},
        {"sweep",
         "megaviews-bench",
         {"sweep",   "builtin:cornell", "--no-cache", "--no-config",  "--scene-depth",
          "5",       "--view-depth",    "5",          "--resolution", "32x18",
          "--sweep", "vpls=64",         "--sweep",    "method=none",  "--frames",
          "1",       "--warmup",        "0",          "--out",        "w"},
         {"w.csv", "w.json"}},
    };
    return all;
}

// The environment in which one call fails: the `at`-th of a kind, on files of `folder`.
std::map<std::string, std::string> fault(const char* kind, long at, const fs::path& folder,
                                         const fs::path& mark, long bytes = 0) {
    fs::remove(mark);
    return {{"LD_PRELOAD", MEGAVIEWS_FAULT_SHIM},
            {"MEGAVIEWS_FAULT_FOLDER", folder.string()},
            {"MEGAVIEWS_FAULT", kind},
            {"MEGAVIEWS_FAULT_AT", std::to_string(at)},
            {"MEGAVIEWS_FAULT_BYTES", std::to_string(bytes)},
            {"MEGAVIEWS_FAULT_MARK", mark.string()}};
}

class Faults : public testing::TestWithParam<Run> {
  protected:
    void SetUp() override {
        const ProcessResult reference =
            sandbox.megaviews(smallPicture({"-o", "reference.exr", "--save-maps", "unused.npy"}));
        MV_SKIP_WITHOUT_GL(reference);
        ASSERT_EQ(reference.code, 0) << reference.err;
        std::string header = "{'descr': '<f4', 'fortran_order': False, 'shape': (16, 16, 3), }";
        header.resize(117, ' ');
        sandbox.write("x.npy", std::string("\x93NUMPY\x01\x00", 8) + '\x76' + '\0' + header + "\n" +
                                   std::string(16 * 16 * 3 * 4, '\0'));
        const ProcessResult good = run({});
        ASSERT_EQ(good.code, 0) << good.err;
        for (const std::string& file : GetParam().outputs) {
            expected[file] = sandbox.text(file);
            ASSERT_NE(expected[file], kOld) << file;
        }
    }
    ProcessResult run(const std::map<std::string, std::string>& environment) const {
        for (const std::string& file : GetParam().outputs) sandbox.write(file, kOld);
        return sandbox.run(GetParam().program, GetParam().arguments, environment);
    }
    // One sentence and the code of the fault, or 0; files as they were or, with 0 always, whole.
    void expectNothingLost(const ProcessResult& r, int faultCode) const {
        EXPECT_TRUE(r.code == faultCode || r.code == 0) << r.code;
        EXPECT_TRUE(r.code > 128 || r.errLine().find('\n') == std::string::npos);
        for (const auto& [file, bytes] : expected) {
            const bool old = r.code != 0 && sandbox.text(file) == kOld;
            EXPECT_TRUE(old || whole(file, bytes)) << file;
        }
        for (const auto& entry : fs::directory_iterator(sandbox.file(""))) {
            EXPECT_FALSE(entry.path().extension() == ".part") << entry.path();
        }
    }
    bool nothingWritten() const {
        return std::all_of(expected.begin(), expected.end(),
                           [&](const auto& file) { return sandbox.text(file.first) == kOld; });
    }
    // Times differ from run to run: JSON that parses is whole, and so are all lines of a table.
    bool whole(const std::string& file, const std::string& bytes) const {
        const std::string text = sandbox.text(file);
        if (file.ends_with(".json")) return nlohmann::json::accept(text);
        if (!file.ends_with(".csv")) return text == bytes;
        return text.ends_with('\n') && std::count(text.begin(), text.end(), '\n') ==
                                           std::count(bytes.begin(), bytes.end(), '\n');
    }
    fs::path mark() const { return sandbox.file("mark"); }

    Sandbox sandbox;
    std::map<std::string, std::string> expected;
};

TEST_P(Faults, OfFilesKeepOldOnesOrWriteWholeOnes) {
    constexpr int kMost = 100, kMostFiles = 30;
    for (const std::string kind : {"open", "write", "close", "rename"}) {
        // Every file is written and renamed once. It is opened and closed twice, the first time by
        // the check before the run: of all those, a third.
        const int step = kind == "write" || kind == "rename" ? 1 : 3;
        int at = 1, hits = 0, missed = 0;
        for (; at <= kMost; at += step) {
            const ProcessResult r = run(fault(kind.c_str(), at, sandbox.file(""), mark()));
            SCOPED_TRACE(kind + " " + std::to_string(at) + "\n" + r.err);
            const bool hit = fs::exists(mark());
            if (!hit) {
                EXPECT_EQ(r.code, 0);
                // The check before the run writes nothing: its files meet no write that could fail.
                const bool mayFollow = kind == "write" && at < kMostFiles;
                ++missed;
                if (mayFollow && r.code == 0 && (hits == 0 || missed < 3)) continue;
                break;
            }
            ++hits;
            missed = 0;
            expectNothingLost(r, 5);  // or 0: a file of the check before is lost without harm
        }
        EXPECT_LT(at, kMost);
        EXPECT_GT(hits, 0) << kind;
        RecordProperty(kind, hits);
    }
}

// A disk that fills up in the middle of a file: no file may have more than so many bytes, for the
// half and all but one of each output's. (The log and standard error are shorter than that.)
TEST_P(Faults, OfRoomKeepOldOnesOrWriteWholeOnes) {
    if (!fs::exists("/usr/bin/prlimit")) GTEST_SKIP() << "there is no prlimit";
    const std::string program = MEGAVIEWS_BINARY_DIR "/" + std::string(GetParam().program);
    int failed = 0;
    for (const auto& [limiting, bytes] : expected) {
        for (const std::size_t most : {bytes.size() / 2, bytes.size() - 1}) {
            Arguments arguments = {"--fsize=" + std::to_string(most), program};
            arguments.insert(arguments.end(), GetParam().arguments.begin(),
                             GetParam().arguments.end());
            for (const std::string& file : GetParam().outputs) sandbox.write(file, kOld);
            const ProcessResult r = sandbox.run("/usr/bin/prlimit", arguments);
            SCOPED_TRACE(limiting + " " + std::to_string(most) + "\n" + r.err);
            failed += r.code != 0;
            expectNothingLost(r, 5);
        }
    }
    EXPECT_GT(failed, 0);
}

// Of large allocations and of all, at numbers further and further apart.
TEST_P(Faults, OfMemoryKeepOldOnesOrWriteWholeOnes) {
    for (const long bytes : {1l << 16, 1l}) {
        long at = 1, most = 10000000;
        for (; at < most; at += 1 + at) {
            const ProcessResult r = run(fault("allocation", at, "", mark(), bytes));
            SCOPED_TRACE("allocation " + std::to_string(at) + " of " + std::to_string(bytes) +
                         " bytes or more\n" + r.err);
            if (!fs::exists(mark())) {
                EXPECT_EQ(r.code, 0);
                break;
            }
            // CLI11 allocates where it promises not to throw, while it reads the command line.
            expectNothingLost(r, r.code == 128 + SIGABRT && nothingWritten() ? r.code : 6);
        }
        EXPECT_LT(at, most);
        RecordProperty("allocations of " + std::to_string(bytes), static_cast<int>(at));
    }
}

INSTANTIATE_TEST_SUITE_P(Outputs, Faults, testing::ValuesIn(runs()),
                         [](const auto& of) { return std::string(of.param.name); });

TEST(FullDevice, IsCode5WhereverItIs) {
    if (!fs::exists("/dev/full")) GTEST_SKIP() << "there is no /dev/full";
    const Sandbox sandbox;
    const auto shell = [&](const std::string& command) {
        return sandbox.run("/bin/sh", {"-c", command});
    };
    const std::string program = MEGAVIEWS_BINARY_DIR "/megaviews";
    for (const char* rest :
         {" --help", " --version", " --list=methods", " builtin:cornell --info"}) {
        const ProcessResult full = shell(program + rest + " > /dev/full");
        EXPECT_EQ(full.code, 5) << rest << full.err;
        EXPECT_NE(full.err.find("standard output"), std::string::npos) << full.err;
        EXPECT_EQ(shell(program + rest + " >&-").code, 5) << rest;
    }
    std::string picture;
    for (const std::string& word : smallPicture({"-o", "a.png", "--log-file", "/dev/full"})) {
        picture += " " + word;
    }
    const ProcessResult log = shell(program + picture);
    MV_SKIP_WITHOUT_GL(log);
    EXPECT_EQ(log.code, 5) << log.err;
    EXPECT_GT(fs::file_size(sandbox.file("a.png")), 1000u);
    // Nothing that is printed gets into a file that is opened in the place of standard output.
    const ProcessResult closed =
        shell(program + picture.substr(0, picture.find(" --log")) + " >&-");
    EXPECT_EQ(closed.code, 5) << closed.err;
    EXPECT_TRUE(sandbox.text("a.png").starts_with("\x89PNG"));
}

// The octree and the reference are kept for the next time: whatever of it fails, the picture is the
// same, and so is the next one, which reads what was kept.
TEST(FullCache, CostsNoPicture) {
    const Sandbox sandbox, pictures;
    const std::string picture = pictures.file("a.png").string();
    Arguments arguments = smallPicture({"--method", "exact", "-o", picture});
    std::erase(arguments, "--no-cache");
    const ProcessResult first = sandbox.megaviews(arguments);
    MV_SKIP_WITHOUT_GL(first);
    ASSERT_EQ(first.code, 0) << first.err;
    const std::string expected = pictures.text("a.png");
    int told = 0;
    constexpr int kMost = 30;
    for (const char* kind : {"open", "write", "close", "rename"}) {
        int at = 1, missed = 0;
        for (; missed < 2 && at < kMost; ++at) {
            fs::remove_all(sandbox.file("cache"));
            fs::remove(picture);
            const ProcessResult r = sandbox.megaviews(
                arguments, fault(kind, at, sandbox.file("cache"), sandbox.file("mark")));
            SCOPED_TRACE(std::string(kind) + " " + std::to_string(at) + "\n" + r.err);
            const bool hit = fs::exists(sandbox.file("mark"));
            missed += !hit;
            told += r.err.find("not kept") != std::string::npos;
            EXPECT_EQ(r.code, 0);
            EXPECT_TRUE(pictures.text("a.png") == expected);
            // What is left half done, by a write or a rename, is what could mislead the next.
            if (!hit || std::string(kind) == "open" || std::string(kind) == "close") continue;
            const ProcessResult next = sandbox.megaviews(arguments);
            EXPECT_EQ(next.code, 0) << next.err;
            EXPECT_EQ(next.errLine(), "");
            EXPECT_TRUE(pictures.text("a.png") == expected);
        }
        EXPECT_GE(missed, 2);
        EXPECT_GT(at, 4) << kind;
    }
    EXPECT_GT(told, 8);

    sandbox.write("file", "");
    for (const char* folder : {"file", "file/below"}) {
        Arguments chosen = arguments;
        chosen.insert(chosen.end(), {"--references", folder});
        EXPECT_EQ(sandbox.megaviews(chosen).code, 5);
    }
}

// ---------------------------------------------------------------- inputs and outputs

TEST(Outputs, AreNeverInputsOrEachOther) {
    const Sandbox sandbox;
    const Arguments untouched = {"s.glb", "c.json", "x.npy", "v.ply", "script"};
    for (const std::string& file : untouched) sandbox.write(file, kOld);
    sandbox.write("c.json", "{}");
    sandbox.write("script", "wait");
    fs::create_symlink("s.glb", sandbox.file("link.json"));
    fs::create_hard_link(sandbox.file("s.glb"), sandbox.file("hard.json"));
    fs::create_hard_link(sandbox.file("x.npy"), sandbox.file("picture.json"));
    fs::create_symlink("new.png", sandbox.file("link.png"));  // leads to what is not there yet
    const std::string here = sandbox.file("").string();
    const struct {
        const char* program;
        Arguments arguments;
    } cases[] = {
        {"megaviews", {"s.glb", "--headless", "--save-scene", "s.glb"}},
        {"megaviews", {"s.glb", "--headless", "--stats", "link.json"}},
        {"megaviews", {"s.glb", "--headless", "--stats", "hard.json"}},
        {"megaviews", {"s.glb", "--log-file", "s.glb", "--info"}},
        {"megaviews", {"--config", "c.json", "--headless", "--stats", "./c.json"}},
        {"megaviews", {"--config", "c.json", "--headless", "--save-state", here + "c.json"}},
        {"megaviews", {"--actions", "@script", "--headless", "--stats", "script"}},
        {"megaviews", {"--actions", "open s.glb; save-state s.glb", "--headless"}},
        {"megaviews", {"--actions", "open s.glb; save-scene s.glb", "--headless"}},
        {"megaviews", {"--views", "v.ply", "--headless", "--save-views", "v.ply"}},
        {"megaviews", {"--headless", "-o", "new.png", "-o", here + "new.png"}},
        {"megaviews", {"--headless", "-o", "new.png", "-o", "link.png"}},
        {"megaviews", {"--headless", "-o", "new.png", "--log-file", "new.png"}},
        {"megaviews", {"--headless", "-o", "new.png", "--actions", "save ./new.png"}},
        {"megaviews-bench", {"compare", "x.npy", "x.npy", "--json", "picture.json"}},
        {"megaviews-bench", {"sweep", "--config", "c.json", "--out", "c"}},
    };
    std::map<std::string, std::string> before;
    for (const std::string& file : untouched) before[file] = sandbox.text(file);
    for (const auto& c : cases) {
        const ProcessResult r = sandbox.run(c.program, c.arguments);
        EXPECT_EQ(r.code, 2) << c.arguments.back() << "\n" << r.err;
        EXPECT_TRUE(r.err.find("overwritten") != std::string::npos ||
                    r.err.find("written twice") != std::string::npos)
            << r.err;
        for (const auto& [file, text] : before) EXPECT_EQ(sandbox.text(file), text) << file;
        EXPECT_FALSE(fs::exists(sandbox.file("new.png")));
    }
}

TEST(Outputs, AreCheckedBeforeAnythingIsLoaded) {
    const Sandbox sandbox;
    const std::string tooLong = std::string(300, 'n') + ".json";
    fs::create_directory(sandbox.file("folder.json"));
    fs::create_symlink("circle.json", sandbox.file("circle.json"));
    for (const std::string& file : {tooLong, std::string("folder.json"), std::string("circle.json"),
                                    std::string("absent/s.json"), std::string("/proc/s.json")}) {
        const ProcessResult r = sandbox.megaviews({"absent.glb", "--headless", "--stats", file});
        EXPECT_EQ(r.code, 5) << file << "\n" << r.err;
        EXPECT_NE(r.err.find(file), std::string::npos) << r.err;
    }
    // A name as long as a name may be is written.
    const std::string longest = std::string(250, 'n') + ".json";
    const ProcessResult r = sandbox.megaviews(smallPicture({"--save-state", longest, "-q"}));
    MV_SKIP_WITHOUT_GL(r);
    EXPECT_EQ(r.code, 0) << r.err;
    EXPECT_TRUE(nlohmann::json::accept(sandbox.text(longest)));
}

TEST(Outputs, FollowLinksAndKeepWhoMayRead) {
    const Sandbox sandbox;
    sandbox.write("old.png", kOld);
    ASSERT_EQ(chmod(sandbox.file("old.png").c_str(), 0600), 0);
    fs::create_symlink("old.png", sandbox.file("link.png"));
    fs::create_symlink("new.png", sandbox.file("dangling.png"));
    const ProcessResult r =
        sandbox.megaviews(smallPicture({"-o", "link.png", "-o", "dangling.png"}));
    MV_SKIP_WITHOUT_GL(r);
    ASSERT_EQ(r.code, 0) << r.err;
    for (const char* file : {"old.png", "new.png"}) {
        EXPECT_TRUE(sandbox.text(file).starts_with("\x89PNG")) << file;
    }
    for (const char* link : {"link.png", "dangling.png"}) {
        EXPECT_TRUE(fs::is_symlink(sandbox.file(link))) << link;
    }
    EXPECT_EQ(fs::status(sandbox.file("old.png")).permissions(),
              fs::perms::owner_read | fs::perms::owner_write);
}

// ---------------------------------------------------------------- inputs

TEST(Inputs, ThatAreNoFilesAreRefusedAtOnce) {
    const Sandbox sandbox;
    fs::create_directory(sandbox.file("folder"));
    ASSERT_EQ(mkfifo(sandbox.file("pipe").c_str(), 0600), 0);
    sandbox.write("deep", std::string(100000, '[') + std::string(100000, ']'));
    sandbox.write("deep.json", sandbox.text("deep"));
    for (const char* ending : {".png", ".exr", ".json", ".npy", ".glb", ".ply"}) {
        fs::create_symlink("pipe", sandbox.file(std::string("pipe") + ending));
    }
    const struct {
        const char* program;
        Arguments arguments;
        int code;
    } cases[] = {
        {"megaviews", {"--config", "folder"}, 2},
        {"megaviews", {"--config", "pipe"}, 2},
        {"megaviews", {"--config", "deep"}, 2},
        {"megaviews", {"--actions", "@folder"}, 2},
        {"megaviews", {"--actions", "@pipe"}, 2},
        {"megaviews", {"--load-state", "deep.json"}, 3},
        {"megaviews", {"--load-state", "pipe.json"}, 3},
        {"megaviews", {"--load-state", "pipe.png"}, 3},
        {"megaviews", {"pipe.glb", "--info"}, 3},
        {"megaviews", {"folder", "--info"}, 3},
        {"megaviews-bench", {"compare", "pipe.npy", "pipe.npy"}, 3},
        {"megaviews-bench", {"sweep", "--sweep", "vpls=1..1M:x1.0000000001"}, 2},
    };
    for (const auto& c : cases) {
        const auto start = std::chrono::steady_clock::now();
        const ProcessResult r = sandbox.run(c.program, c.arguments);
        EXPECT_EQ(r.code, c.code) << c.arguments.back() << "\n" << r.err;
        EXPECT_EQ(r.err.find("internal error"), std::string::npos) << r.err;
        EXPECT_LT(std::chrono::steady_clock::now() - start, std::chrono::seconds(30));
    }
    for (const Arguments& more :
         {Arguments{"--reference", "pipe.exr"}, Arguments{"--views", "pipe.ply"}}) {
        Arguments arguments = smallPicture({"-o", "a.png"});
        arguments.insert(arguments.end(), more.begin(), more.end());
        const ProcessResult r = sandbox.megaviews(arguments);
        MV_SKIP_WITHOUT_GL(r);
        EXPECT_EQ(r.code, 3) << r.err;
    }
}

// ---------------------------------------------------------------- interrupts

// Long work, a signal once it is at work, and two seconds.
TEST(Interrupts, EndLongWorkWithWhatThereIs) {
    const Sandbox sandbox;
    {
        const ProcessResult r = sandbox.megaviews(smallPicture({"-o", "a.png"}));  // shaders
        MV_SKIP_WITHOUT_GL(r);
    }
    const struct {
        const char* program;
        Arguments arguments;
        const char* kept;  // JSON that says that it is partial; empty: nothing is
    } cases[] = {
        // Many frames, then one that takes the software renderer minutes.
        {"megaviews", smallPicture({"--frames", "100000", "--stats", "s.json"}), "s.json"},
        {"megaviews",
         smallPicture({"--resolution", "1920x1080", "--gather-samples", "1024", "--method",
                       "shadow-rays", "--stats", "none.json"}),
         ""},
        {"megaviews",
         smallPicture({"--method", "pathtraced", "--reference-samples", "65536", "--resolution",
                       "640x360", "--stats", "none.json"}),
         ""},
        {"megaviews-bench", {"stress", "--json", "stress.json"}, "stress.json"},
    };
    int signal = SIGINT;
    for (const auto& c : cases) {
        signal = signal == SIGINT ? SIGHUP : SIGINT;
        const pid_t pid = sandbox.start(c.program, c.arguments);
        std::this_thread::sleep_for(std::chrono::seconds(4));
        const auto start = std::chrono::steady_clock::now();
        kill(pid, signal);
        const ProcessResult r = sandbox.wait(pid);
        const std::chrono::duration<double> took = std::chrono::steady_clock::now() - start;
        EXPECT_EQ(r.code, 130) << r.err;
        EXPECT_LT(took.count(), 3) << c.arguments.back();  // 2 and what a busy machine adds
        if (!*c.kept) continue;
        const auto json = nlohmann::json::parse(sandbox.text(c.kept), nullptr, false);
        ASSERT_TRUE(json.is_object()) << r.err;
        const auto& says = json.contains("frames") ? json.at("frames") : json;
        EXPECT_EQ(says.at("partial"), true);
    }
}

}  // namespace
}  // namespace mv
