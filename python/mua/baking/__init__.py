"""The main job: a rigged character and its motion become a verified `.muaavatar`, stage by stage."""
