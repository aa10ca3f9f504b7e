// Generated from python/mua/player/shaders/shadow.hlsl by tools/gen_wgsl.py; do not edit.

/** @type {import("../shader.js").Shader} */
export const ShadowVert = {
  ...{"stage":"vert","entry":"ShadowVert","buffers":[{"name":"vertex_dq","binding":0,"read_only":true,"scalar":"float","stride":16},{"name":"mesh","binding":1,"read_only":true,"scalar":"float","stride":4}],"constants":[{"name":"view_projection","offset":0,"scalar":"float","shape":[4,4],"strides":[4,16],"used":false},{"name":"light","offset":64,"scalar":"float","shape":[4],"strides":[4],"used":true},{"name":"area","offset":80,"scalar":"float","shape":[4],"strides":[4],"used":true},{"name":"size","offset":96,"scalar":"uint","shape":[],"strides":[],"used":false}],"constants_binding":3,"threads":[1,1,1]},
  code: `@binding(0)@group(0)var<storage,read>vertex_dq_0:array<vec4f>;
@binding(1)@group(0)var<storage,read>mesh_0:array<f32>;
struct _MatrixStorage_float4x4_ColMajorstd140_0{@align(16)data_0:array<vec4f,4>,};
struct Constants{@align(16)view_projection_0:_MatrixStorage_float4x4_ColMajorstd140_0,@align(16)light_0:vec4f,@align(16)area_0:vec4f,@align(16)size_0:u32,};
@binding(3)@group(0)var<uniform>Constants_0:Constants;
fn quaternionRotate_0(a:vec4f,b:vec3f)->vec3f{var c=a.yzw;var d=vec3f(2f)*cross(c,b);return b+vec3f(a.x)*d+cross(c,d);}
fn quaternionConjugate_0(a:vec4f)->vec4f{return vec4f(a.x,vec3f(0)-a.yzw);}
fn quaternionMultiply_0(a:vec4f,b:vec4f)->vec4f{var c=a.x;var d=b.x;var e=a.yzw;var f=b.yzw;return vec4f(c*d-dot(e,f),vec3f(c)*f+vec3f(d)*e+cross(e,f));}
fn dualTransform_0(a:vec4f,b:vec4f,c:vec3f)->vec3f{return quaternionRotate_0(a,c)+vec3f(2f)*quaternionMultiply_0(b,quaternionConjugate_0(a)).yzw;}
fn shadowPlace_0(a:vec3f,b:vec3f,c:f32)->vec3f{return a-b*vec3f((a.y-c)/b.y);}
struct vertexOutput_0{@builtin(position)output_0:vec4f,};
fn surfaceVertex_0(a:u32)->vec3f{var b=3u*a;var c=2u*a;return dualTransform_0(vertex_dq_0[c],vertex_dq_0[c+1u],vec3f(mesh_0[b],mesh_0[b+1u],mesh_0[b+2u]));}
@vertex fn ShadowVert(@builtin(vertex_index)a:u32)->vertexOutput_0{var b=(shadowPlace_0(surfaceVertex_0(a),Constants_0.light_0.xyz,Constants_0.area_0.w).xz-Constants_0.area_0.xy)/vec2f(Constants_0.area_0.z);var c=vertexOutput_0(vec4f(2f*b.x-1f,1f-2f*b.y,0.5f,1f));return c;}`,
};

/** @type {import("../shader.js").Shader} */
export const ShadowFrag = {
  ...{"stage":"frag","entry":"ShadowFrag","buffers":[],"constants":[],"constants_binding":null,"threads":[1,1,1]},
  code: `struct pixelOutput_0{@location(0)output_0:vec4f,};
@fragment fn ShadowFrag()->pixelOutput_0{var a=pixelOutput_0(vec4f(vec4i(1i)));return a;}`,
};

/** @type {import("../shader.js").Shader} */
export const GroundVert = {
  ...{"stage":"vert","entry":"GroundVert","buffers":[],"constants":[{"name":"view_projection","offset":0,"scalar":"float","shape":[4,4],"strides":[4,16],"used":true},{"name":"light","offset":64,"scalar":"float","shape":[4],"strides":[4],"used":false},{"name":"area","offset":80,"scalar":"float","shape":[4],"strides":[4],"used":true},{"name":"size","offset":96,"scalar":"uint","shape":[],"strides":[],"used":true}],"constants_binding":3,"threads":[1,1,1]},
  code: `struct _MatrixStorage_float4x4_ColMajorstd140_0{@align(16)data_0:array<vec4f,4>,};
struct Constants{@align(16)view_projection_0:_MatrixStorage_float4x4_ColMajorstd140_0,@align(16)light_0:vec4f,@align(16)area_0:vec4f,@align(16)size_0:u32,};
@binding(3)@group(0)var<uniform>Constants_0:Constants;
struct GroundVaryings_0{@builtin(position)position_0:vec4f,@location(0)at_0:vec2f,};
@vertex fn GroundVert(@builtin(vertex_index)a:u32)->GroundVaryings_0{var b=f32(a&1u);var c=f32(a>>1u);var d=vec2f(b,c);var e:GroundVaryings_0;e.position_0=vec4f(Constants_0.area_0.x+b*Constants_0.area_0.z,Constants_0.area_0.w,Constants_0.area_0.y+c*Constants_0.area_0.z,1f)*mat4x4f(Constants_0.view_projection_0.data_0[0][0],Constants_0.view_projection_0.data_0[1][0],Constants_0.view_projection_0.data_0[2][0],Constants_0.view_projection_0.data_0[3][0],Constants_0.view_projection_0.data_0[0][1],Constants_0.view_projection_0.data_0[1][1],Constants_0.view_projection_0.data_0[2][1],Constants_0.view_projection_0.data_0[3][1],Constants_0.view_projection_0.data_0[0][2],Constants_0.view_projection_0.data_0[1][2],Constants_0.view_projection_0.data_0[2][2],Constants_0.view_projection_0.data_0[3][2],Constants_0.view_projection_0.data_0[0][3],Constants_0.view_projection_0.data_0[1][3],Constants_0.view_projection_0.data_0[2][3],Constants_0.view_projection_0.data_0[3][3]);e.at_0=d*vec2f(f32(Constants_0.size_0));return e;}`,
};

/** @type {import("../shader.js").Shader} */
export const GroundFrag = {
  ...{"stage":"frag","entry":"GroundFrag","buffers":[{"name":"mask","binding":2,"read_only":true,"scalar":"uint","stride":4}],"constants":[{"name":"view_projection","offset":0,"scalar":"float","shape":[4,4],"strides":[4,16],"used":false},{"name":"light","offset":64,"scalar":"float","shape":[4],"strides":[4],"used":true},{"name":"area","offset":80,"scalar":"float","shape":[4],"strides":[4],"used":false},{"name":"size","offset":96,"scalar":"uint","shape":[],"strides":[],"used":true}],"constants_binding":3,"threads":[1,1,1]},
  code: `struct _MatrixStorage_float4x4_ColMajorstd140_0{@align(16)data_0:array<vec4f,4>,};
struct Constants{@align(16)view_projection_0:_MatrixStorage_float4x4_ColMajorstd140_0,@align(16)light_0:vec4f,@align(16)area_0:vec4f,@align(16)size_0:u32,};
@binding(3)@group(1)var<uniform>Constants_0:Constants;
@binding(2)@group(1)var<storage,read>mask_0:array<u32>;
fn splineWeights_0(a:f32)->vec4f{var b=1f-a;return vec4f(b*b*b,4f-6f*a*a+3f*a*a*a,4f-6f*b*b+3f*b*b*b,a*a*a)/vec4f(6f);}
struct pixelOutput_0{@location(0)output_0:vec4f,};
struct pixelInput_0{@location(0)at_0:vec2f,};
fn shadowCover_0(a:vec2f,b:u32)->f32{var c=floor(a-vec2f(0.5f));var d=splineWeights_0(a.x-0.5f-c.x);var e=splineWeights_0(a.y-0.5f-c.y);var f=0i;var g=0f;for(;f<16i;){var h=f%4i;var i=vec2i(c)+vec2i(h,f/4i)-vec2i(1i);var j=all(i>=vec2i(0i))&&all(i<vec2i(i32(b)));var k:u32;if(j){k=u32(i.y)*256u+u32(i.x);}else{k=0u;}var l=f32((mask_0[k/4u]>>(8u*(k%4u)))&255u)/255f;var m:f32;if(j){m=l*d[h]*e[f/4i];}else{m=0f;}var n=g+m;f=f+1i;g=n;}return g;}
@fragment fn GroundFrag(a:pixelInput_0,@builtin(position)b:vec4f)->pixelOutput_0{var c=pixelOutput_0(vec4f(0f,0f,0f,Constants_0.light_0.w*shadowCover_0(a.at_0,Constants_0.size_0)));return c;}`,
};
