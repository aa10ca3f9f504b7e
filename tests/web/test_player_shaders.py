"""The shaders that the browser player loads are those that the tests of tests/parity read."""

import json
import subprocess

import gen_wgsl
from web.test_modules import SECONDS, pytestmark

__all__ = ["pytestmark"]  # skips where Node is missing

LOAD = """
const found = [];
for (const file of process.argv.slice(1))
  for (const [entry, { code }] of Object.entries(await import(file))) found.push([file, entry, code]);
console.log(JSON.stringify(found));
"""


def test_the_player_loads_the_code_that_the_tests_read() -> None:
    files = {path.as_uri(): path.stem for path in gen_wgsl.FOLDER.glob("*.js")}
    command = ["node", "--no-warnings", "--input-type=module", "-e", LOAD, *files]
    ran = subprocess.run(command, capture_output=True, text=True, check=True, timeout=SECONDS)
    loaded = {(files[file], entry): code for file, entry, code in json.loads(ran.stdout)}
    read = {name: shader.code for name, shader in gen_wgsl.read().items()}
    assert loaded.keys() == read.keys()
    assert [name for name, code in read.items() if loaded[name] != code] == []
