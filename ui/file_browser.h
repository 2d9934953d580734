#pragma once
// A file browser made of ImGui alone: one folder's list, a path that can be typed, the folder above
// and the home folder. It only looks at names; opening is the application's.

#include <cstdint>
#include <string>
#include <vector>

#include "ui/model.h"

namespace mv::ui {

class FileBrowser {
  public:
    struct Entry {
        std::string name;
        bool folder = false;
        std::uint64_t bytes = 0;
    };

    // Lists `folder`, or the home folder if it cannot be read; forgets what was typed.
    void open(Browse purpose, const std::string& folder);
    void enter(const std::string& folder);
    void enterParent();
    void enterHome();
    // What a typed or chosen text means: a folder is entered, a file becomes the answer. Empty
    // while there is none; problem() then says why.
    std::string choose(const std::string& text);
    void setAllFiles(bool all);
    // An entry's name becomes what is typed, also where the text is being edited.
    void take(std::size_t entry);
    std::string takeChosen();
    // A typed beginning, as far as the entries that begin so agree; empty if none does.
    std::string completed(const std::string& text) const;

    Browse purpose() const { return purpose_; }
    const std::string& folder() const { return folder_; }
    const std::vector<Entry>& entries() const { return entries_; }
    const std::string& problem() const { return problem_; }
    bool allFiles() const { return allFiles_; }
    // Whether a file would be replaced that is there, where one is to be written.
    bool replaces(const std::string& text) const;

    char typed[1024] = "";  // edited by the dialog
    int selected = -1;      // entry last chosen, -1 = none

  private:
    bool saves() const;
    std::string fileOf(const std::string& text) const;
    void list();

    Browse purpose_ = Browse::none;
    std::string folder_, problem_, chosen_;
    std::vector<Entry> entries_;
    bool allFiles_ = false;
};

// Extensions that the purpose knows, with their dots, lower case.
std::vector<std::string> extensionsOf(Browse purpose);

}  // namespace mv::ui
