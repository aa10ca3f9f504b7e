"""The pages of the site that `make docs` builds: every Markdown file where it lies, what these link to, the reference.

A hook of MkDocs (mkdocs.yml). Files keep their places in the repository, so that their links hold in both.
"""

import ast
import os
import re
from pathlib import Path

from mkdocs.config.defaults import MkDocsConfig
from mkdocs.structure.files import File, Files
from mkdocs.structure.pages import Page
from mkdocs.utils import get_relative_url

ROOT = Path(__file__).resolve().parents[1]
NO_PAGES = ("build", "dist", "node_modules", "LICENSE", ".")  # files and folders that begin like this
LINK = re.compile(r"(!?\[[^\]]*\]\()([^)\s#]+)")
STYLE, SEARCH = "tools/site.css", "tools/site_search.js"
FOREIGN = re.compile(
    r'<script src="https://[^"]*/iframe-worker/[^"]*"></script>'
)  # a script of the theme, for search from the disk
GUIDES, FORMAT, REFERENCE = "docs", "schemas/README.md", "docs/reference.md"
GIVEN = (  # records that public functions take or give
    "mua.rig.rig.Rig",
    "mua.pose.skeleton.Skeleton",
    "mua.pose.encoding.PoseEncoding",
    "mua.baking.distillation.Baked",
    "mua.baking.listener.Listener",
)
OPENING = "# Reference\n\nThe names of `import mua`; [the guide](python.md) shows them at work.\n\n"


def on_config(config: MkDocsConfig) -> MkDocsConfig:
    """Guides in the order of docs/README.md, then the reference and the format, then what builders read."""
    pages = [page.relative_to(ROOT).as_posix() for page in _pages()]
    index = ROOT / GUIDES / "README.md"
    listed = [target.relative_to(ROOT).as_posix() for target in _targets(index) if target.parent == ROOT / GUIDES]
    guides = ["docs/README.md", *(page for page in dict.fromkeys(listed) if page in pages)]
    research = [page for page in pages if page.startswith("docs/research/")]
    first = ["README.md", *guides, *research, FORMAT]
    config.extra_css.append(STYLE)
    config.nav = [
        "README.md",
        {"Guides": guides},
        REFERENCE,
        FORMAT,
        {"Measurements": research},
        {"Inside": [{_place(page): page} for page in pages if page not in first]},
    ]
    return config


def on_files(files: Files, config: MkDocsConfig) -> Files:
    """Pages and images by their paths in the repository, in place of the folder docs alone."""
    theme = [file for file in files if not Path(file.abs_src_path or "").is_relative_to(config.docs_dir)]
    pages = _pages()
    linked = {target for page in pages for target in _targets(page) if target.is_file() and target.suffix != ".md"}
    kept = [_file(config, path) for path in (*pages, *sorted(linked), ROOT / STYLE, ROOT / SEARCH)]
    return Files([*theme, *kept, File.generated(config, REFERENCE, content=OPENING + _entries())])


def on_page_markdown(markdown: str, page: Page, config: MkDocsConfig, files: Files) -> str:
    """Links to folders lead to what these say of themselves."""
    folder = (ROOT / page.file.src_uri).parent

    def leading(link: re.Match[str]) -> str:
        target = link[2]
        return f"{link[1]}{target.rstrip('/')}/README.md" if (folder / target / "README.md").is_file() else link[0]

    return LINK.sub(leading, markdown)


def on_post_page(output: str, page: Page, config: MkDocsConfig) -> str:
    """Nothing is fetched from elsewhere: our own stand-in for workers, which browsers do not start from the disk."""
    own = f'<script src="{get_relative_url(SEARCH, page.url)}"></script>'
    return FOREIGN.sub(own, output)


def on_post_template(output: str, template_name: str, config: MkDocsConfig) -> str:
    """Likewise, on the page for addresses that lead nowhere, which a server shows: it needs no stand-in."""
    return FOREIGN.sub("", output)


def _place(page: str) -> str:
    """The sidebar's name of a page for developers: its folder or file, because titles repeat."""
    return page.removesuffix(".md").removesuffix("/README")


def _pages() -> list[Path]:
    found: list[Path] = []
    for folder, below, names in os.walk(ROOT):
        below[:] = [name for name in below if not name.startswith(NO_PAGES)]
        found += [Path(folder) / name for name in names if name.endswith(".md") and not name.startswith(NO_PAGES)]
    return sorted(found)


def _targets(page: Path) -> list[Path]:
    return [(page.parent / target).resolve() for _, target in LINK.findall(page.read_text())]


def _file(config: MkDocsConfig, path: Path) -> File:
    return File.generated(config, path.relative_to(ROOT).as_posix(), abs_src_path=str(path))


def _entries() -> str:
    """One entry for each public name and for what these take or give, as mkdocstrings reads them."""
    named = [*(f"mua.{name}" for name in _public()), *GIVEN]
    return "\n\n".join(f"::: {name}" for name in named)


def _public() -> list[str]:
    for node in ast.parse((ROOT / "python" / "mua" / "__init__.py").read_text()).body:
        if isinstance(node, ast.Assign) and ast.unparse(node.targets[0]) == "__all__":
            return list(ast.literal_eval(node.value))
    raise RuntimeError("mua names nothing in __all__")
