"""`python -m mua.characters.fbx skinned|animation FILE`: scenes of an FBX file to the process that started this."""

from mua.characters.fbx.process import hand_back

if __name__ == "__main__":
    hand_back()
