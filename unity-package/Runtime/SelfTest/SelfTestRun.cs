using System;
using System.Collections;
using System.Collections.Generic;
using System.Linq;
using UnityEngine;

namespace Mua.SelfTest
{
    /// <summary>Every kernel on its golden buffers, a case in a frame; the log has the outcomes.</summary>
    internal sealed class SelfTestRun
    {
        private const string Mark = "MUA-SELFTEST";

        private readonly RunLog log;
        private readonly string folder;
        private readonly List<GoldenFile> files = new List<GoldenFile>();
        private readonly List<string> problems = new List<string>(); // of what cannot run

        public SelfTestRun(string run, string folder)
        {
            log = new RunLog(Mark, run);
            this.folder = folder;
        }

        public int Passed { get; private set; }

        /// <summary>Cases; 0 until they are known.</summary>
        public int Total { get; private set; }

        public bool HasPassed => Total > 0 && Passed == Total;

        /// <summary>A coroutine; it logs all, and its last line is the result.</summary>
        public IEnumerator Run()
        {
            RunLog.SayDevice();
            AvatarResources resources = Resources();
            if (resources != null)
            {
                var reader = new GoldenReader(folder);
                foreach (string stem in GoldenFile.Stems)
                {
                    IEnumerator reading = reader.Read(stem);
                    while (reading.MoveNext())
                    {
                        yield return null;
                    }
                    Take(stem, reader);
                }
            }
            Total = problems.Count + files.Sum(file => file.cases.Length);
            log.Say("START " + Total);
            foreach (string problem in problems)
            {
                log.Say("FAIL " + problem);
            }
            foreach (GoldenFile file in files)
            {
                foreach (GoldenCase golden in file.cases)
                {
                    Run(file, golden, ShaderOf(resources, file.Stem));
                    yield return null;
                }
            }
            log.Say((HasPassed ? "PASS " : "FAIL ") + Passed + "/" + Total);
        }

        /// <summary>The shader of a kernel's file; null where the package lacks it.</summary>
        public static ComputeShader ShaderOf(AvatarResources resources, string stem)
        {
            switch (stem)
            {
                case "mlp_matmul":
                    return resources.MlpMatmul;
                case "blend_subbands":
                    return resources.BlendSubbands;
                case "inverse_dwt":
                    return resources.InverseDwt;
                case "dq_skinning":
                    return resources.DqSkinning;
                case "expressions":
                    return resources.Expressions;
                case "splat_project":
                    return resources.SplatProject;
                case "splat_sort":
                    return resources.SplatSort;
                default:
                    throw new ArgumentOutOfRangeException("stem", stem, "expected one of GoldenFile.Stems");
            }
        }

        private void Run(GoldenFile file, GoldenCase golden, ComputeShader shader)
        {
            string problem;
            try
            {
                problem = CaseRun.Difference(shader, file, golden);
            }
            catch (Exception error) // whatever the engine refuses is an outcome of this case
            {
                problem = error.Message;
            }
            bool isRight = problem.Length == 0;
            Passed += isRight ? 1 : 0;
            log.Say((isRight ? "PASS " : "FAIL ") + file.Stem + "/" + golden.Word + (isRight ? "" : ": " + problem));
        }

        /// <summary>Less strict than a world of avatars: a kernel that is missing fails by itself.</summary>
        private AvatarResources Resources()
        {
            AvatarResources resources = SystemInfo.supportsComputeShaders ? AvatarResources.Load() : null;
            if (resources == null)
            {
                problems.Add(SystemInfo.supportsComputeShaders
                    ? "device/resources: Runtime/Resources/MuaAvatarResources of com.mua.avatar is missing"
                    : "device/compute: " + SystemInfo.graphicsDeviceName + " (" + SystemInfo.graphicsDeviceType
                        + ") does not support compute shaders");
            }
            return resources;
        }

        private void Take(string stem, GoldenReader reader)
        {
            if (reader.File != null)
            {
                files.Add(reader.File);
            }
            else
            {
                problems.Add(stem + "/golden: " + reader.Problem);
            }
        }
    }
}
